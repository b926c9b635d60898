# find_package(antinode) gives
#   antinode::antinode   the static library: of this PC, or of the core that a cross build is for
#   antinode::shared     the shared library, on a PC
# A cross build names the Rust target in ANTINODE_TARGET (thumbv7em-none-eabihf, thumbv7m-none-eabi, thumbv6m-none-eabi); where it
# does not, the target follows from -mcpu in CMAKE_C_FLAGS.
get_filename_component(_antinode_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(_antinode_lib "${_antinode_prefix}/lib")
if(CMAKE_CROSSCOMPILING)
    if(NOT ANTINODE_TARGET)
        if(CMAKE_C_FLAGS MATCHES "-mcpu=cortex-m[47].*-mfloat-abi=hard|-mfloat-abi=hard.*-mcpu=cortex-m[47]")
            set(ANTINODE_TARGET thumbv7em-none-eabihf)
        elseif(CMAKE_C_FLAGS MATCHES "-mcpu=cortex-m(3|4|7)")
            set(ANTINODE_TARGET thumbv7m-none-eabi)
        elseif(CMAKE_C_FLAGS MATCHES "-mcpu=cortex-m0")
            set(ANTINODE_TARGET thumbv6m-none-eabi)
        endif()
    endif()
    set(_antinode_lib "${_antinode_lib}/${ANTINODE_TARGET}")
endif()

if(NOT EXISTS "${_antinode_lib}/libantinode.a")
    set(antinode_FOUND FALSE)
    set(antinode_NOT_FOUND_MESSAGE "no ${_antinode_lib}/libantinode.a: install antinode for the target, and name it in ANTINODE_TARGET")
    return()
endif()

if(NOT TARGET antinode::antinode)
    add_library(antinode::antinode STATIC IMPORTED)
    set_target_properties(antinode::antinode PROPERTIES
        IMPORTED_LOCATION "${_antinode_lib}/libantinode.a"
        INTERFACE_INCLUDE_DIRECTORIES "${_antinode_prefix}/include")
endif()
if(NOT CMAKE_CROSSCOMPILING AND EXISTS "${_antinode_lib}/libantinode.so" AND NOT TARGET antinode::shared)
    add_library(antinode::shared SHARED IMPORTED)
    set_target_properties(antinode::shared PROPERTIES
        IMPORTED_LOCATION "${_antinode_lib}/libantinode.so"
        INTERFACE_INCLUDE_DIRECTORIES "${_antinode_prefix}/include")
endif()

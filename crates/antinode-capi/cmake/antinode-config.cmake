# find_package(antinode) defines
#   antinode::antinode   the static library: for this PC, or for the core of a cross build
#   antinode::shared     the shared library, on a PC
# A cross build names the Rust target in ANTINODE_TARGET (README.md lists them: thumbv7em-none-eabihf, ...). If it does not, the
# target follows from the last -mcpu and -mfloat-abi in CMAKE_C_FLAGS, CMAKE_CXX_FLAGS or add_compile_options(), and, without
# -mfloat-abi, the float ABI follows from clang's triple (--target=...eabihf).
# Links first: where /lib leads to /usr/lib, a package in /usr may be found as /lib/cmake/antinode.
get_filename_component(_antinode_prefix "${CMAKE_CURRENT_LIST_DIR}" REALPATH)
get_filename_component(_antinode_prefix "${_antinode_prefix}/../../.." ABSOLUTE)
set(_antinode_lib "${_antinode_prefix}/lib")
if(CMAKE_CROSSCOMPILING)
    set(_antinode_target "${ANTINODE_TARGET}")
    if(NOT _antinode_target)
        get_directory_property(_antinode_options COMPILE_OPTIONS)
        set(_antinode_flags " ${CMAKE_C_FLAGS} ${CMAKE_CXX_FLAGS} ${_antinode_options} ")
        # CMake puts the triple before all other flags.
        foreach(_antinode_language C CXX)
            if(CMAKE_${_antinode_language}_COMPILER_TARGET)
                set(_antinode_flags " --target=${CMAKE_${_antinode_language}_COMPILER_TARGET}${_antinode_flags}")
            endif()
        endforeach()
        set(_antinode_abi "")
        if(_antinode_flags MATCHES ".*[ ;]-m(float-abi=hard|float-abi=softfp|float-abi=soft|hard-float|soft-float)[ ;]")
            set(_antinode_abi "${CMAKE_MATCH_1}")
        elseif(_antinode_flags MATCHES ".*[ ;](--target=|-target[ ;])([^ ;]+)[ ;]")
            if(CMAKE_MATCH_2 MATCHES "eabihf$")
                set(_antinode_abi hard)
            endif()
        endif()
        set(_antinode_core "")
        set(_antinode_has_dsp "^(4|7|33|35p|52|55|85)$")
        if(_antinode_flags MATCHES ".*[ ;]-mcpu=cortex-m([0-9a-z]+)([+.][^ ;]*)?[ ;]")
            set(_antinode_core "${CMAKE_MATCH_1}")
            if(CMAKE_MATCH_2 MATCHES "[+]nodsp")
                set(_antinode_core nodsp)
            endif()
        endif()
        # Never an archive with another float ABI: the linker may accept it, and arguments would be passed in the wrong registers.
        if(_antinode_abi MATCHES "hard")
            if(_antinode_core MATCHES "${_antinode_has_dsp}")
                set(_antinode_target thumbv7em-none-eabihf)
            elseif(_antinode_core STREQUAL nodsp)
                set(_antinode_target thumbv8m.main-none-eabihf)
            endif()
        elseif(_antinode_core MATCHES "${_antinode_has_dsp}" AND EXISTS "${_antinode_lib}/thumbv7em-none-eabi/libantinode.a")
            set(_antinode_target thumbv7em-none-eabi)
        elseif(_antinode_core MATCHES "^(3|nodsp)$" OR _antinode_core MATCHES "${_antinode_has_dsp}")
            set(_antinode_target thumbv7m-none-eabi)
        elseif(_antinode_core MATCHES "^(0|0plus|1|23)$")
            set(_antinode_target thumbv6m-none-eabi)
        endif()
    endif()
    if(NOT _antinode_target)
        set(antinode_FOUND FALSE)
        set(antinode_NOT_FOUND_MESSAGE "the flags do not tell which core this build is for: name the Rust target in ANTINODE_TARGET, \
say -DANTINODE_TARGET=thumbv7em-none-eabihf, and install antinode for it; add_compile_options(-mcpu=...) counts before find_package()")
        return()
    endif()
    set(_antinode_lib "${_antinode_lib}/${_antinode_target}")
endif()

if(NOT EXISTS "${_antinode_lib}/libantinode.a")
    set(antinode_FOUND FALSE)
    set(antinode_NOT_FOUND_MESSAGE "no ${_antinode_lib}/libantinode.a: install antinode for the target, and name it in ANTINODE_TARGET")
    if(CMAKE_CROSSCOMPILING AND _antinode_target STREQUAL thumbv7m-none-eabi AND NOT ANTINODE_TARGET AND _antinode_core MATCHES "${_antinode_has_dsp}")
        string(APPEND antinode_NOT_FOUND_MESSAGE "; on this core thumbv7em-none-eabi is faster")
    endif()
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

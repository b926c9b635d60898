# find_package(antinode) gives
#   antinode::antinode   the static library: of this PC, or of the core that a cross build is for
#   antinode::shared     the shared library, on a PC
# A cross build names the Rust target in ANTINODE_TARGET (README.md has which: thumbv7em-none-eabihf, ...); where it
# does not, the target follows from -mcpu and -mfloat-abi in CMAKE_C_FLAGS, CMAKE_CXX_FLAGS or add_compile_options(), of
# which the last counts; the float ABI, where no -mfloat-abi says it, from clang's triple (--target=...eabihf).
get_filename_component(_antinode_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(_antinode_lib "${_antinode_prefix}/lib")
if(CMAKE_CROSSCOMPILING)
    set(_antinode_target "${ANTINODE_TARGET}")
    if(NOT _antinode_target)
        get_directory_property(_antinode_options COMPILE_OPTIONS)
        set(_antinode_flags " ${CMAKE_C_FLAGS} ${CMAKE_CXX_FLAGS} ${_antinode_options} ")
        # CMake gives a compiler its triple before all flags.
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
        # Never across float ABIs: the linker may not see it, and arguments would go astray.
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
say -DANTINODE_TARGET=thumbv7em-none-eabihf, and install antinode for it")
        return()
    endif()
    set(_antinode_lib "${_antinode_lib}/${_antinode_target}")
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

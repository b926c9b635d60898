# Prints which library Zephyr's module links:  cmake -DCONFIG_…=y -DANTINODE_PREFIX=PREFIX -P zephyr.cmake.
# The functions below stand in for those of Zephyr.
set(CONFIG_ANTINODE y)
function(zephyr_get)
endfunction()
function(zephyr_include_directories)
endfunction()
function(zephyr_link_libraries library)
    message(STATUS "found: ${library}")
endfunction()
include(${CMAKE_CURRENT_LIST_DIR}/../../zephyr/CMakeLists.txt)

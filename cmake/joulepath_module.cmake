# joulepath_module(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...])
#
# One static library per folder of the architecture, with the namespaced alias that everything links:
# joulepath::NAME. A module without sources is an interface library (headers only).
function(joulepath_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target joulepath_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    joulepath_warnings(${target})
    joulepath_unity(${target})
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(joulepath::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/joulepath>)
  target_link_libraries(${target} ${scope} ${ARG_PUBLIC})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY JOULEPATH_MODULES ${target})
endfunction()

# The warnings that every target of ours is built with. GCC 12 raises two of them falsely inside of
# std::string (GCC bugs 105329 and 105562): left out for GCC alone.
function(joulepath_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
    $<$<BOOL:${JOULEPATH_WERROR}>:-Werror>)
endfunction()

# With JOULEPATH_UNITY the sources of one folder of a target are compiled as one unit: headers are parsed once.
# Names in anonymous namespaces are therefore unique within a folder. Design: docs/decisions/0800-build.md
function(joulepath_unity target)
  if(NOT JOULEPATH_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(IS_ABSOLUTE ${source})
      continue()  # generated
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${folder}_of_${target}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

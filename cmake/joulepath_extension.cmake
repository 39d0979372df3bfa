# Extensions: targets of their own that add readers, exporters and commands to the core. Design: docs/decisions/0800-build.md
# In the order of the help.
set(JOULEPATH_ALL_EXTENSIONS
  bags
  vda5050
  nav2
  onboard
  studies
  studio
  fleet
  simulators)
set(JOULEPATH_EXTENSIONS all CACHE STRING "Extensions to build, separated by semicolons; all: every one; empty: the core alone")

# The chosen extensions, in the order of JOULEPATH_ALL_EXTENSIONS.
function(joulepath_chosen_extensions out)
  set(chosen ${JOULEPATH_EXTENSIONS})
  if(chosen STREQUAL "all")
    set(chosen ${JOULEPATH_ALL_EXTENSIONS})
  endif()
  foreach(name IN LISTS chosen)
    if(NOT name IN_LIST JOULEPATH_ALL_EXTENSIONS)
      message(FATAL_ERROR "JOULEPATH_EXTENSIONS: found ${name}, accepted: all, or some of ${JOULEPATH_ALL_EXTENSIONS}")
    endif()
  endforeach()
  set(sorted "")
  foreach(name IN LISTS JOULEPATH_ALL_EXTENSIONS)
    if(name IN_LIST chosen)
      list(APPEND sorted ${name})
    endif()
  endforeach()
  set(${out} "${sorted}" PARENT_SCOPE)
endfunction()

# Libraries that chosen extensions alone need: their files dependencies.cmake, read in the scope of the whole build.
joulepath_chosen_extensions(chosen)
set(JOULEPATH_DEPENDENCY_FILES "")
foreach(name IN LISTS chosen)
  if(EXISTS ${PROJECT_SOURCE_DIR}/extensions/${name}/dependencies.cmake)
    include(${PROJECT_SOURCE_DIR}/extensions/${name}/dependencies.cmake)
    list(APPEND JOULEPATH_DEPENDENCY_FILES ${name})
  endif()
endforeach()

# joulepath_extension(NAME [SOURCES...] [COMMANDS sources...] [PUBLIC libs...] [PRIVATE libs...])
#
# SOURCES define `void add_NAME(Registry&)` (scenarios/registry.hpp) and become joulepath::NAME, a module of the library.
# COMMANDS define `void add_NAME_commands(ProgramParts&)` (app/program_parts.hpp) and are a part of the program alone.
# The file `adds` beside the CMakeLists.txt lists the words that belong to the extension; dependencies.cmake, if there is
# one, finds libraries and names their pkg-config modules in JOULEPATH_PKG_CONFIG.
function(joulepath_extension name)
  cmake_parse_arguments(ARG "" "" "SOURCES;COMMANDS;PUBLIC;PRIVATE" ${ARGN})
  set_property(GLOBAL PROPERTY JOULEPATH_ADDS_OF_${name} ${CMAKE_CURRENT_SOURCE_DIR}/adds)
  set(readers "")
  if(ARG_SOURCES)
    joulepath_module(${name} SOURCES ${ARG_SOURCES} PUBLIC joulepath::scenarios ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    set_property(GLOBAL APPEND PROPERTY JOULEPATH_READERS ${name})
    set(readers joulepath::${name})
  endif()
  if(ARG_COMMANDS)
    set(target joulepath_${name}_commands)
    add_library(${target} STATIC ${ARG_COMMANDS})
    add_library(joulepath::${name}_commands ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name}_commands)
    joulepath_warnings(${target})
    joulepath_unity(${target})
    target_link_libraries(${target} PUBLIC joulepath_app PRIVATE ${readers} joulepath::report ${ARG_PRIVATE})
    set_property(GLOBAL APPEND PROPERTY JOULEPATH_COMMAND_TARGETS ${target})
  endif()
endfunction()

# joulepath_extension_list(FILE NAMES...): FILE.cpp and FILE_commands.cpp, which call the functions of these extensions and
# list the words of all. A list of calls, not constructors of static objects: a linker drops objects that nothing names.
set(JOULEPATH_LIST_TEMPLATES ${CMAKE_CURRENT_LIST_DIR})
function(joulepath_extension_list file)
  set(LIST_DECLARATIONS "")
  set(LIST_CALLS "")
  set(LIST_WORDS "")
  set(COMMAND_DECLARATIONS "")
  set(COMMAND_CALLS "")
  set(all ${JOULEPATH_ALL_EXTENSIONS} ${ARGN})
  list(REMOVE_DUPLICATES all)
  get_property(readers GLOBAL PROPERTY JOULEPATH_READERS)
  foreach(name IN LISTS all)
    get_property(adds GLOBAL PROPERTY JOULEPATH_ADDS_OF_${name})
    if(NOT adds)
      set(adds ${PROJECT_SOURCE_DIR}/extensions/${name}/adds)
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${adds})
    set(is_built false)
    if(name IN_LIST ARGN)
      set(is_built true)
    endif()
    if(is_built AND name IN_LIST readers)
      string(APPEND LIST_DECLARATIONS "void add_${name}(Registry& registry);\n")
      string(APPEND LIST_CALLS "  add_${name}(registry);\n")
    endif()
    if(TARGET joulepath_${name}_commands AND is_built)
      string(APPEND COMMAND_DECLARATIONS "void add_${name}_commands(ProgramParts& parts);\n")
      string(APPEND COMMAND_CALLS "  parts.extension = \"${name}\";\n  add_${name}_commands(parts);\n")
    endif()
    file(STRINGS ${adds} lines REGEX "^[a-z]")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "^([a-z]+) *(.*)$" _ "${line}")
      string(APPEND LIST_WORDS "      {\"${name}\", \"${CMAKE_MATCH_1}\", \"${CMAKE_MATCH_2}\", ${is_built}},\n")
    endforeach()
  endforeach()
  configure_file(${JOULEPATH_LIST_TEMPLATES}/extension_list.cpp.in ${file}.cpp @ONLY)
  configure_file(${JOULEPATH_LIST_TEMPLATES}/extension_commands.cpp.in ${file}_commands.cpp @ONLY)
endfunction()

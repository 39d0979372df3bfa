# joulepath_embed(TARGET OUT.cpp name=file ...): text files into `extern const std::string_view name;` of
# namespace joulepath::embedded. Run again by the build whenever one of the files changes.
if(CMAKE_SCRIPT_MODE_FILE)
  set(code "#include <string_view>\n\nnamespace joulepath::embedded {\n")
  foreach(entry IN LISTS ENTRIES)
    string(REGEX MATCH "^([^=]+)=(.*)$" _ "${entry}")
    set(name ${CMAKE_MATCH_1})
    file(READ "${CMAKE_MATCH_2}" text)
    string(REGEX REPLACE "/[*/]# sourceMappingURL=[^\n]*" "" text "${text}") # the map is not embedded
    string(APPEND code "extern const std::string_view ${name};\nconst std::string_view ${name} = R\"_embed_(")
    string(APPEND code "${text}" ")_embed_\";\n")
  endforeach()
  string(APPEND code "}  // namespace joulepath::embedded\n")
  file(WRITE "${OUT}" "${code}")
  return()
endif()

set(JOULEPATH_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(joulepath_embed target out)
  set(files "")
  foreach(entry IN LISTS ARGN)
    string(REGEX REPLACE "^[^=]+=" "" file "${entry}")
    list(APPEND files "${file}")
  endforeach()
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} "-DENTRIES=${ARGN}" -DOUT=${out} -P ${JOULEPATH_EMBED_SCRIPT}
    DEPENDS ${files} ${JOULEPATH_EMBED_SCRIPT} VERBATIM
    COMMENT "Embedding text files into ${target}")
  target_sources(${target} PRIVATE ${out})
  set_source_files_properties(${out} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings) # Clang counts them
endfunction()

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

# joulepath_modules(OUT_ENTRIES HEADER TABLE PREFIX FOLDER module...): JavaScript modules PREFIX/module.js of FOLDER for
# joulepath_embed, and a header with a table of them (app/report/page_text.hpp).
set(JOULEPATH_MODULES_TEMPLATE ${CMAKE_CURRENT_LIST_DIR}/modules.hpp.in)
function(joulepath_modules out header table prefix folder)
  set(entries "")
  set(MODULE_TABLE ${table})
  set(MODULE_DECLARATIONS "")
  set(MODULE_ROWS "")
  file(RELATIVE_PATH place ${PROJECT_SOURCE_DIR} ${folder})
  foreach(module IN LISTS ARGN)
    list(APPEND entries ${prefix}_module_${module}=${folder}/${module}.js)
    string(APPEND MODULE_DECLARATIONS "extern const std::string_view ${prefix}_module_${module};\n")
    string(APPEND MODULE_ROWS "    {\"${prefix}/${module}.js\", \"${place}/${module}.js\", embedded::${prefix}_module_${module}},\n")
  endforeach()
  configure_file(${JOULEPATH_MODULES_TEMPLATE} ${PROJECT_BINARY_DIR}/generated/${header} @ONLY)
  set(${out} ${entries} PARENT_SCOPE)
endfunction()

# joulepath_build_id(NAME): a library with the digest of app/build_id.hpp. It covers the content of all sources of the
# program and its pages, the compiler and its flags; no time and no folder. The folders are searched, so that no source can be forgotten.
# Design: docs/decisions/0700-results-and-jobs.md
set(JOULEPATH_BUILD_PATTERNS "")
foreach(folder model planner diagnosis scenarios app extensions)
  list(APPEND JOULEPATH_BUILD_PATTERNS ${folder}/*.cpp ${folder}/*.hpp ${folder}/CMakeLists.txt)
endforeach()
foreach(folder app extensions) # what the program's pages hold
  list(APPEND JOULEPATH_BUILD_PATTERNS ${folder}/*.js ${folder}/*.css ${folder}/*.html)
endforeach()
list(APPEND JOULEPATH_BUILD_PATTERNS scenarios/schemas/*.yaml extensions/*/schemas.yaml extensions/simulators/templates/*.xml extensions/bags/*.msg cmake/*.cmake)

if(CMAKE_SCRIPT_MODE_FILE)
  list(TRANSFORM JOULEPATH_BUILD_PATTERNS PREPEND ${ROOT}/)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${JOULEPATH_BUILD_PATTERNS})
  list(SORT files)
  set(listing "${COMPILER}\n")
  foreach(file CMakeLists.txt ${files})
    file(SHA256 ${ROOT}/${file} digest)
    string(APPEND listing "${digest} ${file}\n")
  endforeach()
  string(SHA256 digest "${listing}")
  string(SUBSTRING ${digest} 0 16 digest)
  file(WRITE ${OUT} "#include \"app/build_id.hpp\"\n\nnamespace joulepath {\nconst std::string_view kBuildId = \"${digest}\";\n}\n")
  return()
endif()

set(JOULEPATH_BUILD_ID_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(joulepath_build_id name)
  list(TRANSFORM JOULEPATH_BUILD_PATTERNS PREPEND ${PROJECT_SOURCE_DIR}/)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${JOULEPATH_BUILD_PATTERNS})
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  set(compiler "${JOULEPATH_EXTENSIONS} ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
  string(REGEX REPLACE "-f[a-z]+-prefix-map=[^ ]*" "" compiler "${compiler}") # names the folder of the build
  set(out ${CMAKE_CURRENT_BINARY_DIR}/build_id.cpp)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DOUT=${out} "-DCOMPILER=${compiler}" -P ${JOULEPATH_BUILD_ID_SCRIPT}
    DEPENDS ${PROJECT_SOURCE_DIR}/CMakeLists.txt ${files} ${JOULEPATH_BUILD_ID_SCRIPT} VERBATIM
    COMMENT "Digest of the sources")
  add_library(${name} STATIC ${out}) # for itself: a generated source of another library waits for all that the library links
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
endfunction()

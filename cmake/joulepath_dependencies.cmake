# Read by the build, and by joulepathConfig.cmake in projects that use an installed joulepath.
# Everything comes from the distribution; nothing is downloaded (docs/decisions/0800-build.md).
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(NLopt REQUIRED)
find_package(PNG REQUIRED)
find_package(Boost 1.74 REQUIRED) # headers: odeint (integration), math (distributions)
pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)
if(NOT JOULEPATH_CONSUMER) # of the program alone; projects that use the library do without
  find_package(CLI11 REQUIRED)
endif()

if(NOT TARGET yaml-cpp::yaml-cpp)
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()

# Ipopt: 3.11 has its headers in coin/ and needs HAVE_CSTDDEF, 3.14 in coin-or/; pkg-config names the folder.
add_library(joulepath_ipopt INTERFACE IMPORTED GLOBAL)
target_link_libraries(joulepath_ipopt INTERFACE PkgConfig::IPOPT)
target_compile_definitions(joulepath_ipopt INTERFACE HAVE_CSTDDEF)

# OMPL: Debian's pkg-config file and CMake variables name libraries that are not there; take the library itself.
find_path(OMPL_INCLUDE_DIR ompl/config.h PATH_SUFFIXES ompl-1.5 ompl-1.6 ompl REQUIRED)
find_library(OMPL_LIBRARY ompl REQUIRED)
add_library(joulepath_ompl INTERFACE IMPORTED GLOBAL)
target_include_directories(joulepath_ompl SYSTEM INTERFACE ${OMPL_INCLUDE_DIR} ${EIGEN3_INCLUDE_DIR})
target_link_libraries(joulepath_ompl INTERFACE ${OMPL_LIBRARY} Boost::headers Eigen3::Eigen)

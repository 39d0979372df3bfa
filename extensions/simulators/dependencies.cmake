# URDF, SDF and MJCF are XML.
find_package(PkgConfig REQUIRED)
pkg_check_modules(TINYXML2 REQUIRED IMPORTED_TARGET tinyxml2)
list(APPEND JOULEPATH_PKG_CONFIG tinyxml2)

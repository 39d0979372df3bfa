# Chunks of MCAP are compressed; a rosbag2 is a database.
find_package(PkgConfig REQUIRED)
find_package(SQLite3 3.37 REQUIRED) # PRAGMA table_list tells views from tables
find_package(ZLIB REQUIRED)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
list(APPEND JOULEPATH_PKG_CONFIG zlib liblz4 libzstd sqlite3)

# METIS comes without a CMake package.
find_path(TREAD_METIS_INCLUDE metis.h REQUIRED)
find_library(TREAD_METIS_LIBRARY metis REQUIRED)
add_library(tread_metis INTERFACE)
target_include_directories(tread_metis SYSTEM INTERFACE ${TREAD_METIS_INCLUDE})
target_link_libraries(tread_metis INTERFACE ${TREAD_METIS_LIBRARY})

# Finds the SuiteSparse parts by name (Debian 12 ships neither a CMake package nor .pc files for them).
# Usage: find_package(SuiteSparse COMPONENTS KLU CHOLMOD BTF AMD COLAMD). Targets: SuiteSparse::KLU ...
include(FindPackageHandleStandardArgs)
set(_suitesparse_required)
foreach(component IN LISTS SuiteSparse_FIND_COMPONENTS)
  string(TOLOWER ${component} _name)
  find_path(SuiteSparse_${component}_INCLUDE NAMES ${_name}.h PATH_SUFFIXES suitesparse)
  find_library(SuiteSparse_${component}_LIBRARY NAMES ${_name})
  mark_as_advanced(SuiteSparse_${component}_INCLUDE SuiteSparse_${component}_LIBRARY)
  list(APPEND _suitesparse_required SuiteSparse_${component}_LIBRARY SuiteSparse_${component}_INCLUDE)
  if(SuiteSparse_${component}_LIBRARY AND SuiteSparse_${component}_INCLUDE)
    set(SuiteSparse_${component}_FOUND TRUE)
    if(NOT TARGET SuiteSparse::${component})
      add_library(SuiteSparse::${component} UNKNOWN IMPORTED)
      set_target_properties(SuiteSparse::${component} PROPERTIES
        IMPORTED_LOCATION "${SuiteSparse_${component}_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${SuiteSparse_${component}_INCLUDE}")
    endif()
  endif()
endforeach()
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS ${_suitesparse_required} HANDLE_COMPONENTS)

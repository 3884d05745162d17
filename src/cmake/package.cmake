# Before CPack packs: the Python module stands where Debian's Python looks below /usr, which is not where it looks below /usr/local.
file(GLOB folders "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3.*/*-packages")
foreach(folder IN LISTS folders)
  get_filename_component(version ${folder} DIRECTORY)
  file(MAKE_DIRECTORY "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3")
  file(RENAME ${folder} "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3/dist-packages")
  file(REMOVE_RECURSE ${version})
endforeach()

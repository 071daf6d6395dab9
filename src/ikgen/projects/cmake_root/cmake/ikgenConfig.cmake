# Leads to the package files: inside an installed package, or beside src in a checkout.
foreach(_ikgen_templates "../../../templates" "../../../../../templates")
  if(EXISTS "${CMAKE_CURRENT_LIST_DIR}/${_ikgen_templates}/cmake/ikgenConfig.cmake")
    include("${CMAKE_CURRENT_LIST_DIR}/${_ikgen_templates}/cmake/ikgenConfig.cmake")
    return()
  endif()
endforeach()
set(ikgen_FOUND FALSE)
set(ikgen_NOT_FOUND_MESSAGE "this installation of ikgen has no CMake files")

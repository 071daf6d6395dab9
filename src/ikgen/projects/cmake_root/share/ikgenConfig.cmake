# Installed as <prefix>/share/cmake/ikgen: leads to the package files by asking the command that is
# installed beside it.
find_program(IKGEN_EXECUTABLE ikgen
  HINTS "${CMAKE_CURRENT_LIST_DIR}/../../../bin" "${CMAKE_CURRENT_LIST_DIR}/../../../Scripts"
  NO_CMAKE_FIND_ROOT_PATH
  DOC "The ikgen command")
set(_ikgen_directory)
if(IKGEN_EXECUTABLE)
  execute_process(
    COMMAND "${IKGEN_EXECUTABLE}" cmake-dir
    OUTPUT_VARIABLE _ikgen_directory
    OUTPUT_STRIP_TRAILING_WHITESPACE
    RESULT_VARIABLE _ikgen_result)
endif()
if(_ikgen_directory AND EXISTS "${_ikgen_directory}/ikgenConfig.cmake")
  include("${_ikgen_directory}/ikgenConfig.cmake")
else()
  set(ikgen_FOUND FALSE)
  set(ikgen_NOT_FOUND_MESSAGE "the command 'ikgen' was not found: set IKGEN_EXECUTABLE")
endif()

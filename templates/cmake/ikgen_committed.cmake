include_guard(GLOBAL)

function(ikgen_committed target)
  set(one_value DIRECTORY NAME CONFIG SAMPLES)
  cmake_parse_arguments(PARSE_ARGV 1 arg "VERIFY" "${one_value}" "")
  _ikgen_check_arguments("ikgen_committed(${target})" "VERIFY;${one_value}")
  if(NOT arg_DIRECTORY)
    message(FATAL_ERROR
      "ikgen_committed(${target}): DIRECTORY <dir> is missing\n"
      "hint: name the folder that the config has as 'out'")
  endif()
  if(NOT arg_NAME)
    string(MAKE_C_IDENTIFIER "${target}" arg_NAME)
  endif()
  get_filename_component(folder "${arg_DIRECTORY}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
  if(NOT EXISTS "${folder}/${arg_NAME}_ik.json")
    message(FATAL_ERROR
      "ikgen_committed(${target}): no outputs of ikgen: ${folder}/${arg_NAME}_ik.json\n"
      "hint: run ikgen build, commit what it writes, and give the arm's name as NAME")
  endif()
  set(has_header FALSE)
  if(EXISTS "${folder}/${arg_NAME}_ik.hpp")
    set(has_header TRUE)
  endif()
  _ikgen_add_library(${target} "${arg_NAME}" "${folder}" ${has_header})
  if(arg_CONFIG)
    get_filename_component(config "${arg_CONFIG}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
    if(NOT EXISTS "${config}")
      message(FATAL_ERROR
        "ikgen_committed(${target}): no such file: ${config}\n"
        "hint: CONFIG is relative to ${CMAKE_CURRENT_SOURCE_DIR}")
    endif()
    # relative: the command that a failed test names is then short
    file(RELATIVE_PATH config "${CMAKE_CURRENT_SOURCE_DIR}" "${config}")
    set_property(TARGET ${target} PROPERTY INTERFACE_IKGEN_VERIFY "${config}")
  else()
    set_property(TARGET ${target} PROPERTY INTERFACE_IKGEN_VERIFY "${folder}/${arg_NAME}_ik.json")
  endif()
  if(arg_VERIFY)
    get_property(checked TARGET ${target} PROPERTY INTERFACE_IKGEN_VERIFY)
    _ikgen_add_verification(${target} "${checked}" "${arg_SAMPLES}")
  endif()
endfunction()

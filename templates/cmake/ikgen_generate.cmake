include_guard(GLOBAL)

function(ikgen_generate target)
  set(one_value ROBOT NAME BASE TIP TASK TOOL_AXIS CALIBRATION SAMPLES)
  set(multi_value ARGS PACKAGE_PATH FREE LOCK COUPLE EMIT DEPENDS)
  cmake_parse_arguments(PARSE_ARGV 1 arg "VERIFY" "${one_value}" "${multi_value}")
  _ikgen_check_arguments("ikgen_generate(${target})" "VERIFY;${one_value};${multi_value}")
  if(NOT arg_ROBOT)
    message(FATAL_ERROR
      "ikgen_generate(${target}): ROBOT <urdf-or-xacro> is missing\n"
      "hint: ikgen_generate(${target} ROBOT urdf/my_robot.urdf.xacro BASE base_link TIP tool0)")
  endif()
  get_filename_component(robot "${arg_ROBOT}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
  if(NOT EXISTS "${robot}" AND NOT arg_DEPENDS)
    message(FATAL_ERROR
      "ikgen_generate(${target}): no such file: ${robot}\n"
      "hint: ROBOT is relative to ${CMAKE_CURRENT_SOURCE_DIR}; name a file that the build makes in "
      "DEPENDS too")
  endif()
  if(NOT arg_NAME)
    string(MAKE_C_IDENTIFIER "${target}" arg_NAME)
  endif()
  if(NOT arg_EMIT)
    set(arg_EMIT cpp)
  endif()

  set(folder "${CMAKE_CURRENT_BINARY_DIR}/ikgen/${target}")
  set(stamp "${folder}/${arg_NAME}.stamp")
  set(outputs)
  set(byproducts)
  set(has_header FALSE)
  if("cpp" IN_LIST arg_EMIT)
    set(has_header TRUE)
    list(APPEND outputs "${folder}/${arg_NAME}_ik.hpp")
  endif()
  if("python" IN_LIST arg_EMIT)
    list(APPEND outputs "${folder}/${arg_NAME}_ik.py")
  endif()
  if(outputs)  # packages have their records inside
    list(APPEND outputs "${folder}/${arg_NAME}_ik.json")
    set(byproducts BYPRODUCTS ${outputs})
  endif()

  set(command from-urdf)
  if(robot MATCHES "\\.[Tt][Oo][Mm][Ll]$")
    set(command from-dh)
  endif()
  # The folder is the target's own: what earlier options made there goes (--only, --force).
  string(REPLACE ";" "," emit "${arg_EMIT}")
  set(options --name "${arg_NAME}" --emit "${emit}")
  foreach(keyword BASE TIP TASK TOOL_AXIS SAMPLES)
    if(arg_${keyword})
      string(TOLOWER "--${keyword}" option)
      string(REPLACE "_" "-" option "${option}")
      list(APPEND options "${option}" "${arg_${keyword}}")
    endif()
  endforeach()
  foreach(keyword FREE LOCK COUPLE)
    string(TOLOWER "--${keyword}" option)
    foreach(value IN LISTS arg_${keyword})
      list(APPEND options "${option}" "${value}")
    endforeach()
  endforeach()
  if(arg_CALIBRATION)
    get_filename_component(value "${arg_CALIBRATION}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND options --calibration "${value}")
    list(APPEND arg_DEPENDS "${value}")
  endif()
  foreach(value IN LISTS arg_ARGS)
    list(APPEND options --arg "${value}")
  endforeach()
  foreach(value IN LISTS arg_PACKAGE_PATH)
    get_filename_component(value "${value}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
    if(NOT IS_DIRECTORY "${value}")
      message(FATAL_ERROR
        "ikgen_generate(${target}): no such directory: ${value}\n"
        "hint: PACKAGE_PATH names directories that hold packages of $(find ...) and package://")
    endif()
    list(APPEND options --package-path "${value}")
  endforeach()

  # A depfile tells the files that xacro included, and ikgen's own; its target must be spelled as the build tool
  # spells it, which policy CMP0116 changes for Ninja.
  set(depfile)
  if(CMAKE_GENERATOR MATCHES "Ninja" OR CMAKE_VERSION VERSION_GREATER_EQUAL 3.20)
    set(depfile DEPFILE "${folder}/${arg_NAME}.d")
    if(POLICY CMP0116)
      cmake_policy(SET CMP0116 NEW)
    endif()
  endif()
  set(depfile_target "${stamp}")
  if(CMAKE_VERSION VERSION_LESS 3.20)
    file(RELATIVE_PATH depfile_target "${CMAKE_BINARY_DIR}" "${stamp}")
  endif()

  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(
    OUTPUT "${stamp}"
    ${byproducts}
    COMMAND "${IKGEN_EXECUTABLE}" ${command} "${robot}" ${options} -q -o "${folder}" --only --force
      --depfile "${folder}/${arg_NAME}.d" --depfile-target "${depfile_target}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
    DEPENDS "${robot}" ${arg_DEPENDS}
    ${depfile}
    COMMENT "Generating inverse kinematics ${arg_NAME}_ik from ${arg_ROBOT}"
    VERBATIM)
  add_custom_target(${target}_generate ALL DEPENDS "${stamp}")

  _ikgen_add_library(${target} "${arg_NAME}" "${folder}" ${has_header})
  add_dependencies(${target} ${target}_generate)

  if(arg_VERIFY)
    _ikgen_add_verification(${target} "${folder}" "${arg_SAMPLES}")
  endif()
endfunction()

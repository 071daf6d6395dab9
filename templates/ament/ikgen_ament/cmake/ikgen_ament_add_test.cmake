# Verify outputs as an ament test: what `colcon test` runs and `colcon test-result` reads.
#
#   ikgen_ament_add_test(<target> [SAMPLES <n>] [TIMEOUT <seconds>])
#
# The test <target>_verify checks the outputs of ikgen_generate() or ikgen_committed() against the
# description as it is now. It fails if the geometry changed, with the deviation in mm and rad and the
# command that puts it right.
function(ikgen_ament_add_test target)
  cmake_parse_arguments(arg "" "SAMPLES;TIMEOUT" "" ${ARGN})
  _ikgen_check_arguments("ikgen_ament_add_test(${target})" "SAMPLES, TIMEOUT")
  _ikgen_ament_check_target("ikgen_ament_add_test(${target})" ${target})
  get_property(checked TARGET ${target} PROPERTY INTERFACE_IKGEN_VERIFY)
  set(options)
  if(arg_SAMPLES)
    set(options --samples "${arg_SAMPLES}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set(results "${AMENT_TEST_RESULTS_DIR}/${PROJECT_NAME}/${target}_verify.xunit.xml")
  ament_add_test(${target}_verify
    COMMAND "${IKGEN_EXECUTABLE}" verify "${checked}" ${options} --junit-xml "${results}"
    RESULT_FILE "${results}"
    TIMEOUT ${arg_TIMEOUT}
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()

# ikgen: closed-form inverse kinematics code from a robot description, as a build step.
#
#   find_package(ikgen REQUIRED)
#   ikgen_generate(<target> ROBOT <urdf-or-xacro>
#     [NAME <name>] [BASE <link>] [TIP <link>] [TASK <task>] [ARGS <name>:=<value>...]
#     [PACKAGE_PATH <dir>...] [FREE <joint>[=<value>]...] [LOCK <joint>=<value>...]
#     [COUPLE <joint>=<source>*k+c...]
#     [EMIT cpp python ...] [SAMPLES <n>] [DEPENDS <file>...] [VERIFY])
#
# makes the INTERFACE library <target> (alias ikgen::<target>) with the emitted header
# <name>_ik.hpp on its include path. Outputs lie in ${CMAKE_CURRENT_BINARY_DIR}/ikgen/<target>, which
# the target property INTERFACE_IKGEN_OUTPUT_DIR holds. They are made again when the description changes, or a
# file that xacro includes, or a file of DEPENDS, and when ikgen is updated. VERIFY adds the test <target>_verify.
#
#   ikgen_committed(<target> DIRECTORY <dir> [NAME <name>] [CONFIG <ikgen.toml>] [SAMPLES <n>] [VERIFY])
#
# makes the same library from outputs that `ikgen build` wrote and that are committed: nothing is
# generated. VERIFY adds the test <target>_verify, which checks them against the description as it is
# now and fails if that changed; CONFIG is the config to check and to name in the message.

cmake_minimum_required(VERSION 3.16)

set(ikgen_FOUND TRUE)

# The command of the installation that this file belongs to, before others on the path. It runs on
# the machine that builds, so a toolchain file for another one must not move the search.
get_filename_component(_ikgen_real "${CMAKE_CURRENT_LIST_FILE}" REALPATH)
get_filename_component(_ikgen_here "${_ikgen_real}" DIRECTORY)
find_program(IKGEN_EXECUTABLE ikgen
  HINTS
    "${_ikgen_here}/../../../../../../bin"
    "${_ikgen_here}/../../../../../Scripts"
    "${_ikgen_here}/../../../bin"
  NO_CMAKE_FIND_ROOT_PATH
  DOC "The ikgen command")
if(NOT IKGEN_EXECUTABLE)
  set(ikgen_FOUND FALSE)
  set(ikgen_NOT_FOUND_MESSAGE
    "the command 'ikgen' was not found: activate its environment or set IKGEN_EXECUTABLE")
  return()
endif()

include("${CMAKE_CURRENT_LIST_DIR}/ikgen_library.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/ikgen_generate.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/ikgen_committed.cmake")

# What ikgen_generate() and ikgen_committed() share.
include_guard(GLOBAL)

# Stops with the call and the keywords there are, if the caller's arguments hold something else.
macro(_ikgen_check_arguments call keywords)
  if(arg_UNPARSED_ARGUMENTS)
    string(REPLACE ";" ", " _ikgen_keywords "${keywords}")
    message(FATAL_ERROR
      "${call}: unknown arguments: ${arg_UNPARSED_ARGUMENTS}\nhint: the keywords are ${_ikgen_keywords}")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR
      "${call}: no value for: ${arg_KEYWORDS_MISSING_VALUES}\nhint: write it after the keyword, or leave both out")
  endif()
endmacro()

# Sets the cache variable IKGEN_EIGEN_INCLUDE_DIR: the headers that ikgen itself verifies with, "" where it has none.
function(_ikgen_find_own_eigen)
  if(IKGEN_EIGEN_INCLUDE_DIR)
    return()
  endif()
  set(found "")
  execute_process(COMMAND "${IKGEN_EXECUTABLE}" doctor --json OUTPUT_VARIABLE told ERROR_QUIET)
  if(told MATCHES "\"Eigen\": \"([^\"]+)\"")
    file(TO_CMAKE_PATH "${CMAKE_MATCH_1}" found)
    message(STATUS "ikgen: CMake finds no Eigen3; using the headers in ${found}")
  else()
    message(WARNING
      "ikgen: Eigen was not found, which the generated header includes\n"
      "hint: apt-get install libeigen3-dev, or set CMAKE_PREFIX_PATH or IKGEN_EIGEN_INCLUDE_DIR to where it is")
  endif()
  set(IKGEN_EIGEN_INCLUDE_DIR "${found}" CACHE PATH "Eigen's headers, where CMake finds no Eigen3" FORCE)
endfunction()

# Eigen as a target, if the project has found it or it can be found, else the headers of ikgen's own: linking it
# spares users a line.
function(_ikgen_link_eigen target)
  if(NOT TARGET Eigen3::Eigen)
    find_package(Eigen3 QUIET NO_MODULE)
  endif()
  if(TARGET Eigen3::Eigen)
    target_link_libraries(${target} INTERFACE Eigen3::Eigen)
    return()
  endif()
  _ikgen_find_own_eigen()
  if(IKGEN_EIGEN_INCLUDE_DIR)
    target_include_directories(${target} SYSTEM INTERFACE "$<BUILD_INTERFACE:${IKGEN_EIGEN_INCLUDE_DIR}>")
  endif()
endfunction()

# The INTERFACE library of the outputs <name>_ik.* in a folder.
function(_ikgen_add_library target name folder has_header)
  add_library(${target} INTERFACE)
  add_library(ikgen::${target} ALIAS ${target})
  target_compile_features(${target} INTERFACE cxx_std_17)
  target_include_directories(${target} INTERFACE
    "$<BUILD_INTERFACE:${folder}>" "$<INSTALL_INTERFACE:include>")
  set_target_properties(${target} PROPERTIES
    INTERFACE_IKGEN_NAME "${name}"
    INTERFACE_IKGEN_OUTPUT_DIR "${folder}"
    INTERFACE_IKGEN_VERIFY "${folder}")
  if(has_header)
    set_property(TARGET ${target} PROPERTY INTERFACE_IKGEN_HEADER "${folder}/${name}_ik.hpp")
    _ikgen_link_eigen(${target})
  endif()
endfunction()

# The test <target>_verify of a config or of a folder with outputs.
function(_ikgen_add_verification target checked samples)
  set(options)
  if(samples)
    set(options --samples "${samples}")
  endif()
  add_test(NAME ${target}_verify
    COMMAND "${IKGEN_EXECUTABLE}" verify "${checked}" ${options}
      --junit-xml "${CMAKE_CURRENT_BINARY_DIR}/ikgen/${target}/${target}_verify.xunit.xml"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()

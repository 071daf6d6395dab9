# Install what ikgen_generate() or ikgen_committed() made, and export it to other packages.
#
#   ikgen_ament_install(<target> [PYTHON_PACKAGE <name>])
#
# The header goes to include/${PROJECT_NAME}; other packages link ${PROJECT_NAME}::<target> after
# find_package(${PROJECT_NAME}). The Python module goes into the package <name>, which
# ament_python_install_package(<name>) installs. Call it before ament_package().
#
# A macro: ament_export_*() set variables of the caller's scope, which ament_package() reads.
macro(ikgen_ament_install target)
  _ikgen_ament_install(${target} ${ARGN})
  ament_export_targets(${target})
  ament_export_dependencies(Eigen3)
endmacro()

function(_ikgen_ament_install target)
  cmake_parse_arguments(arg "" "PYTHON_PACKAGE" "" ${ARGN})
  _ikgen_check_arguments("ikgen_ament_install(${target})" "PYTHON_PACKAGE")
  _ikgen_ament_check_target("ikgen_ament_install(${target})" ${target})
  get_property(folder TARGET ${target} PROPERTY INTERFACE_IKGEN_OUTPUT_DIR)
  get_property(name TARGET ${target} PROPERTY INTERFACE_IKGEN_NAME)
  get_property(header TARGET ${target} PROPERTY INTERFACE_IKGEN_HEADER)
  if(TARGET ${target}_generate)
    # what is installed has to be there even if nothing of this package links the library
    set_property(TARGET ${target}_generate PROPERTY EXCLUDE_FROM_ALL FALSE)
  endif()
  if(header)
    install(FILES "${header}" DESTINATION include/${PROJECT_NAME})
  endif()
  # of the package alone: a plain `include` would shadow packages of other workspaces
  set_property(TARGET ${target} PROPERTY INTERFACE_INCLUDE_DIRECTORIES
    "$<BUILD_INTERFACE:${folder}>" "$<INSTALL_INTERFACE:include/${PROJECT_NAME}>")
  install(TARGETS ${target} EXPORT ${target})
  if(arg_PYTHON_PACKAGE)
    if(NOT PYTHON_INSTALL_DIR)
      message(FATAL_ERROR
        "ikgen_ament_install(${target}): PYTHON_PACKAGE needs ament_cmake_python\n"
        "hint: find_package(ament_cmake_python REQUIRED) and "
        "ament_python_install_package(${arg_PYTHON_PACKAGE}) before it")
    endif()
    install(FILES "${folder}/${name}_ik.py"
      DESTINATION "${PYTHON_INSTALL_DIR}/${arg_PYTHON_PACKAGE}")
  endif()
endfunction()

function(_ikgen_ament_check_target call target)
  set(folder)
  if(TARGET ${target})
    get_property(folder TARGET ${target} PROPERTY INTERFACE_IKGEN_OUTPUT_DIR)
  endif()
  if(NOT folder)
    message(FATAL_ERROR
      "${call}: not a target of ikgen\n"
      "hint: make it first: ikgen_generate(${target} ...) or ikgen_committed(${target} ...)")
  endif()
endfunction()

# The Python module `ostraka`: the native part, and the package around it. Built for the distribution's Python, to which its pybind11
# and NumPy belong; -DPython3_EXECUTABLE=... selects another.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 COMPONENTS Interpreter Development.Module)
find_path(PYBIND11_INCLUDE pybind11/pybind11.h)
set(missing "")
if(NOT Python3_Development.Module_FOUND)
  list(APPEND missing "Python's headers (python3-dev)")
else()
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import numpy" RESULT_VARIABLE no_numpy OUTPUT_QUIET ERROR_QUIET)
  if(no_numpy)
    list(APPEND missing "NumPy (python3-numpy)")
  endif()
endif()
if(NOT PYBIND11_INCLUDE)
  list(APPEND missing "pybind11 (pybind11-dev)")
endif()
if(missing)
  list(JOIN missing ", " missing)
  message(WARNING "The Python module is LEFT OUT: ${missing} cannot be found. Install it, or set OSTRAKA_PYTHON=OFF")
  return()
endif()

Python3_add_library(ostraka_python MODULE WITH_SOABI apps/python/module.cpp apps/python/objects.cpp
  apps/python/running.cpp apps/python/saved.cpp)
target_include_directories(ostraka_python SYSTEM PRIVATE ${PYBIND11_INCLUDE})
target_link_libraries(ostraka_python PRIVATE ostraka ostraka_flags fmt::fmt)
# Placed beside the package's own files, so that the folder can be imported from; symbols of the library stay hidden in the module.
set(OSTRAKA_PYTHON_BUILT ${CMAKE_BINARY_DIR}/python)
set_target_properties(ostraka_python PROPERTIES OUTPUT_NAME _ostraka CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${OSTRAKA_PYTHON_BUILT}/ostraka)
target_link_options(ostraka_python PRIVATE LINKER:--exclude-libs,ALL)
file(GLOB_RECURSE package_files RELATIVE ${CMAKE_SOURCE_DIR}/apps/python CONFIGURE_DEPENDS
  apps/python/ostraka/*.py apps/python/ostraka/py.typed)
foreach(file IN LISTS package_files)
  get_filename_component(folder ${file} DIRECTORY)
  file(MAKE_DIRECTORY ${OSTRAKA_PYTHON_BUILT}/${folder})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/apps/python/${file} ${OSTRAKA_PYTHON_BUILT}/${file} SYMBOLIC)
endforeach()
# The type stubs, generated from the table of operations.
list(TRANSFORM package_files PREPEND ${CMAKE_SOURCE_DIR}/apps/python/ OUTPUT_VARIABLE package_sources)
set(stubs ${CMAKE_BINARY_DIR}/generated/python_stubs)
add_custom_command(OUTPUT ${stubs}/made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${stubs}
  COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${OSTRAKA_PYTHON_BUILT} PYTHONDONTWRITEBYTECODE=1 ${Python3_EXECUTABLE} -m ostraka stubs ${stubs}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${stubs} ${OSTRAKA_PYTHON_BUILT}/ostraka
  COMMAND ${CMAKE_COMMAND} -E touch ${stubs}/made
  DEPENDS ostraka_python ${package_sources} COMMENT "Type stubs of the Python module" VERBATIM)
add_custom_target(ostraka_python_stubs ALL DEPENDS ${stubs}/made)

# Debian's Python searches this folder below /usr and /usr/local, so that a package and `cmake --install` can both use it. It is
# specific to one version, like the native part. CMAKE_INSTALL_LIBDIR would be a different folder below /usr.
set(OSTRAKA_PYTHON_DIR lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages CACHE STRING
  "Where the Python module is installed, below the prefix")
install(TARGETS ostraka_python LIBRARY DESTINATION ${OSTRAKA_PYTHON_DIR}/ostraka COMPONENT python)
install(DIRECTORY apps/python/ostraka DESTINATION ${OSTRAKA_PYTHON_DIR} COMPONENT python
  FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY ${stubs}/ DESTINATION ${OSTRAKA_PYTHON_DIR}/ostraka COMPONENT python FILES_MATCHING PATTERN "*.pyi")
message(STATUS "The Python module is for ${Python3_EXECUTABLE} (${Python3_VERSION}), below the prefix in ${OSTRAKA_PYTHON_DIR}")

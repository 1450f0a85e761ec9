# The Python package ipia beside vtkmodules.
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
set(ipia_python_destination "lib/python3/dist-packages")
vtk_module_wrap_python(
  MODULES ${ipia_modules}
  TARGET IPIA::Python
  PYTHON_PACKAGE ipia
  MODULE_DESTINATION "${ipia_python_destination}"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/IPIA"
  SOABI "${Python3_SOABI}"
  BUILD_STATIC OFF
  INSTALL_HEADERS OFF)
configure_file("${CMAKE_CURRENT_LIST_DIR}/ipia.py.in"
  "${CMAKE_BINARY_DIR}/${ipia_python_destination}/ipia/__init__.py" COPYONLY)
install(FILES "${CMAKE_BINARY_DIR}/${ipia_python_destination}/ipia/__init__.py"
  DESTINATION "${ipia_python_destination}/ipia")

# The Python package ipia beside vtkmodules.
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
set(ipia_python_destination "lib/python3/dist-packages")
# The extension module finds the library beside it, wherever the tree is installed.
file(RELATIVE_PATH ipia_path_to_library
  "/prefix/${ipia_python_destination}/ipia" "/prefix/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_INSTALL_RPATH "$ORIGIN/${ipia_path_to_library}")
vtk_module_wrap_python(
  MODULES ${ipia_modules}
  TARGET IPIA::Python
  PYTHON_PACKAGE ipia
  MODULE_DESTINATION "${ipia_python_destination}"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/IPIA"
  SOABI "${Python3_SOABI}"
  BUILD_STATIC OFF
  INSTALL_HEADERS OFF)
unset(CMAKE_INSTALL_RPATH)
configure_file("${CMAKE_CURRENT_LIST_DIR}/ipia.py.in"
  "${CMAKE_BINARY_DIR}/${ipia_python_destination}/ipia/__init__.py" COPYONLY)
install(FILES "${CMAKE_BINARY_DIR}/${ipia_python_destination}/ipia/__init__.py"
  DESTINATION "${ipia_python_destination}/ipia")

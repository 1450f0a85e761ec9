# The mathematics, free of VTK: part of the module, and a library of its own for the core's tests.
foreach (name IN ITEMS
    AutomaticLattice BrickLattice BrickOperator BrickSpline CollocationOperator ConstraintRows FarField
    HierarchicalFit HierarchyLevel ImplicitFit ImplicitSpline
    KnotRefinement LeastSquaresSolver Oscillation PointSamples RationalOperator RationalSolver
    TouchedCoefficients)
  list(APPEND ipia_core_sources "${CMAKE_CURRENT_LIST_DIR}/${name}.cxx")
  list(APPEND ipia_core_headers "${CMAKE_CURRENT_LIST_DIR}/${name}.h")
endforeach ()
foreach (name IN ITEMS CubicBasis Dispatch HermiteRows Lattice OutsideDomain Parallel SolverControl Types)
  list(APPEND ipia_core_headers "${CMAKE_CURRENT_LIST_DIR}/${name}.h")
endforeach ()

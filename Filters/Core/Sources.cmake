# The mathematics, free of VTK: part of the module, and a library of its own for the core's tests.
foreach (name IN ITEMS
    AttributeFit AttributeSpline AutomaticFairing AutomaticLattice BSplineBasis BrickLattice BrickOperator BrickSpline
    CollocationOperator ConstraintRows FairingIteration FairingSystem FarField HierarchicalFit HierarchyLevel
    ImplicitFit ImplicitSpline IncrementalFit KnotRefinement LeastSquaresSolver LonePoints Oscillation Parametrization
    PointSamples RationalOperator RationalSolver RowBatches SampleChecks SampleJudge ScanMotions SplineSampling TensorSpline
    TouchedCoefficients)
  list(APPEND ipia_core_sources "${CMAKE_CURRENT_LIST_DIR}/${name}.cxx")
  list(APPEND ipia_core_headers "${CMAKE_CURRENT_LIST_DIR}/${name}.h")
endforeach ()
foreach (name IN ITEMS
    BandMatrix BulkVector CubicBasis Dispatch FairingKernel HermiteRows Lattice MortonOrder OutsideDomain Parallel
    RowKernel RowRegisters SampleGrid SolverControl TileSweep Types)
  list(APPEND ipia_core_headers "${CMAKE_CURRENT_LIST_DIR}/${name}.h")
endforeach ()

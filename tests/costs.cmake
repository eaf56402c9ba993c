# Seconds that the longest tests take, roughly; read by ctest once tests are known. A test that began last would keep one
# processor busy and the others idle.
foreach(test_cost
    ProgramSlow.CutsAPipe=50
    ExtremesStripSlow.StripsOfShortShellsBendWithoutGivingWay=40
    TransactionSlow.NoRowIsLostWhereverAnIndexNodeSplits=40
    InvarianceSlow.TurningAndVibratingCubeGainsNoEnergyInThousandsOfTurns=30
    FoldingStripSlow.NeverPassesThroughItself=30
    HertzSlow.AccurateMeetsForceAndDurationNoWorseThanTheDefault=30
    AuditPredicate.AgreesWithExactArithmetic=10
    ExtremesDeck.AHundredThousandPartsAreReadBuiltAndSteppedInProportionateTime=10
    MemoryOfScenes.ArePredictedWithinAThird=10
    Passes.FindWhatALookAtEveryPairFinds=10)
  string(REPLACE "=" ";" test_cost ${test_cost})
  list(GET test_cost 0 test)
  list(GET test_cost 1 cost)
  set_tests_properties(${test} PROPERTIES COST ${cost})
endforeach()

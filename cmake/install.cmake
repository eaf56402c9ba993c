# The program, the libraries with their headers, and the package that find_package(Brio) finds.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Brio)

set_target_properties(brio_common PROPERTIES EXPORT_NAME common)
install(TARGETS brio_common brio_base brio_elements brio_contact brio_core brio_forecast brio_io EXPORT BrioTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS brio RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# Headers include each other from the root of the project. Those on HDF5 are read by sources of io/ alone.
foreach(folder src materials elements contact io)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/brio
    FILES_MATCHING PATTERN *.hpp PATTERN hdf5_*.hpp EXCLUDE PATTERN dump_checksums.hpp EXCLUDE)
endforeach()
install(EXPORT BrioTargets NAMESPACE Brio:: DESTINATION ${package})
configure_package_config_file(cmake/BrioConfig.cmake.in ${PROJECT_BINARY_DIR}/BrioConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/BrioConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/BrioConfig.cmake ${PROJECT_BINARY_DIR}/BrioConfigVersion.cmake
  DESTINATION ${package})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

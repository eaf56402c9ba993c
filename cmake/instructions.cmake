# Options that turn on those sets of instructions which decide how lanes are laid out and handed over, as far as the
# compiler uses them with its present options and those given.
function(brio_instructions result)
  separate_arguments(options UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/no_code.cpp "")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${options} ${ARGN} -dM -E
    ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/no_code.cpp OUTPUT_VARIABLE macros COMMAND_ERROR_IS_FATAL ANY)
  set(found "")
  foreach(set AVX AVX2 FMA AVX512F AVX512CD AVX512DQ AVX512BW AVX512VL)
    if(macros MATCHES "#define __${set}__ 1")
      string(TOLOWER -m${set} option)
      list(APPEND found ${option})
    endif()
  endforeach()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()

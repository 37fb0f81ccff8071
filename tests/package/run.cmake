file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
execute_process(COMMAND ${WORK}/build/consumer ${WORK}/prefix/share/elastocheck/scenes/pinned_bar.yaml
                OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "converged in 100 steps")
  message(FATAL_ERROR "the consumer said: ${said}")
endif()
execute_process(COMMAND ${WORK}/prefix/bin/elastocheck inspect ${WORK}/prefix/share/elastocheck/scenes/pinned_bar.yaml
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# consumer(name expected WITHOUT package... ARGUMENTS ...): a project that finds the package where others are not to
# be found, builds, and says what is expected.
function(consumer name expected)
  cmake_parse_arguments(arg "" "" "WITHOUT;ARGUMENTS" ${ARGN})
  list(TRANSFORM arg_WITHOUT REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
  run(${CMAKE_COMMAND} -S ${CONSUMERS}/${name} -B ${WORK}/build/${name} -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
      "-DCMAKE_CXX_FLAGS=${FLAGS}" ${arg_WITHOUT})
  run(${CMAKE_COMMAND} --build ${WORK}/build/${name})
  execute_process(COMMAND ${WORK}/build/${name}/${name} ${arg_ARGUMENTS} OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  if(NOT said MATCHES "${expected}")
    message(FATAL_ERROR "${name} said: ${said}")
  endif()
endfunction()
consumer(recursion "converged at -0.01 m" WITHOUT Ceres NLopt yaml-cpp CLI11 nlohmann_json)
consumer(consumer "converged in 100 steps" WITHOUT Ceres NLopt CLI11 nlohmann_json
         ARGUMENTS ${WORK}/prefix/share/elastocheck/scenes/pinned_bar.yaml)
# The program of the README, on the scene that the README names.
consumer(example "\n80 mm: -?[0-9.]+ deg\n$" WITHOUT CLI11
         ARGUMENTS ${WORK}/prefix/share/elastocheck/scenes/double_wishbone.yaml)
# The other one: a solver as a leg.
consumer(candidate "off on .*\nfail, [0-9]+ numbers compared\n$" WITHOUT CLI11
         ARGUMENTS ${WORK}/prefix/share/elastocheck/scenes/mcpherson.yaml)
execute_process(COMMAND ${WORK}/prefix/bin/elastocheck inspect ${WORK}/prefix/share/elastocheck/scenes/pinned_bar.yaml
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

foreach(text man/man1/elastocheck.1 doc/elastocheck/copyright)
  file(SIZE ${WORK}/prefix/share/${text} size)
  if(size LESS 500)
    message(FATAL_ERROR "${text} has ${size} bytes")
  endif()
endforeach()

# The installed gate on a scene that lives outside the repository: accepted, passed, and caught once it is changed.
file(REMOVE_RECURSE ${WORK}/own)
file(COPY ${WORK}/prefix/share/elastocheck/scenes/pinned_bar.yaml DESTINATION ${WORK}/own)
function(gate expected)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=CI ${WORK}/prefix/bin/elastocheck gate pinned_bar.yaml ${ARGN}
                  WORKING_DIRECTORY ${WORK}/own OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE code)
  if(NOT code EQUAL expected)
    message(FATAL_ERROR "gate ${ARGN}: exit code ${code}, not ${expected}: ${said}")
  endif()
endfunction()
gate(3)
gate(0 --accept --reason "a scene of one's own")
gate(0)
file(READ ${WORK}/own/pinned_bar.yaml scene)
string(REPLACE "to: 5000" "to: 5100" changed "${scene}")
file(WRITE ${WORK}/own/pinned_bar.yaml "${changed}")
gate(3)
string(REPLACE "rates: [20, 20, 20]" "rates: [20, 20, 21]" changed "${scene}")
file(WRITE ${WORK}/own/pinned_bar.yaml "${changed}")
gate(1)

# Counts the instructions of recursive::solve over the published sweep (valgrind --tool=callgrind), and compares
# with the count in COUNTS for this compiler and these flags, or writes it there (RECORD).
find_program(VALGRIND valgrind NO_CACHE)  # looked for now: it may be newer than the build
if(NOT VALGRIND)
  message("not judged: valgrind is not installed")
  return()
endif()
execute_process(
  COMMAND ${VALGRIND} --tool=callgrind --callgrind-out-file=/dev/null
          "--toggle-collect=elastocheck::recursive::solve(elastocheck::Model const&, elastocheck::Branch const&, elastocheck::recursive::Options const&, std::function<void (elastocheck::Equilibrium const&)> const&)"
          ${SWEEP} ${SCENE}
  OUTPUT_VARIABLE said ERROR_VARIABLE told RESULT_VARIABLE failed)
if(failed OR NOT said MATCHES "600 steps" OR NOT told MATCHES "Collected : ([0-9]+)")
  message(FATAL_ERROR "the sweep was not counted: ${failed} ${said} ${told}")
endif()
set(count ${CMAKE_MATCH_1})
if(count LESS 600000)  # a thousand a step: less is not a sweep
  message(FATAL_ERROR "only ${count} instructions were collected")
endif()

set(recorded "")
set(others "")
if(EXISTS ${COUNTS})
  file(STRINGS ${COUNTS} lines)
  foreach(line IN LISTS lines)
    if(line MATCHES "^([0-9]+),(.*)$")
      if(CMAKE_MATCH_2 STREQUAL BUILD)
        string(REGEX REPLACE ",.*" "" recorded "${line}")
      else()
        string(APPEND others "${line}\n")
      endif()
    endif()
  endforeach()
endif()
if(RECORD)
  file(WRITE ${COUNTS} "instructions,build\n${others}${count},${BUILD}\n")
  message("${COUNTS}: ${count} instructions for ${BUILD}")
  return()
endif()
if(NOT recorded)
  message("not judged: ${count} instructions, and none are recorded for ${BUILD}")
  return()
endif()
math(EXPR allowed "${recorded} / 50")
math(EXPR more "${count} - ${recorded}")
math(EXPR permille "1000 * ${more} / ${recorded}")
message("${count} instructions, ${recorded} recorded: ${permille} per mille more, 20 allowed either way")
if(more GREATER allowed OR more LESS -${allowed})
  message(FATAL_ERROR "Slower is a regression. Faster, or meant: cmake --build --preset release --target "
                      "record_instructions, and commit ${COUNTS} with the reason.")
endif()

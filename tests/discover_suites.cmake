cmake_minimum_required(VERSION 3.25)
# Registers one ctest entry per GoogleTest suite of a test program, so that the tests of a suite share one process and
# what they computed in it. Run after the program is linked:
#   cmake -D NAME=x -D PROGRAM=test_x -D OUTPUT=test_x_suites.cmake -D LONG=regex -P discover_suites.cmake
# Labels: `slow` for suites whose name begins with Nightly, which only `ctest -C nightly` runs; `long` for those that
# match LONG; `fast` for the others.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests failed: ${failed}")
endif()
string(REGEX REPLACE "\n +[^\n]*" "" listed "\n${listed}")  # the tests of each suite are indented
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}")       # type parameters
string(REGEX MATCHALL "[^\n]+\\.\n" suites "${listed}\n")
set(entries)
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "\\.\n$" "" suite "${suite}")
  set(entry "${NAME}.${suite}")
  set(label fast)
  if(suite MATCHES "^Nightly")
    set(label slow)
  elseif(entry MATCHES "${LONG}")
    set(label long)
  endif()
  set(begin)
  set(end)
  if(label STREQUAL "slow")
    set(begin "if(CTEST_CONFIGURATION_TYPE STREQUAL \"nightly\")\n")
    set(end "endif()\n")
  endif()
  string(APPEND entries "${begin}"
    "add_test([==[${entry}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==] --gtest_brief=1)\n"
    "set_tests_properties([==[${entry}]==] PROPERTIES LABELS ${label} TIMEOUT 3600)\n" "${end}")
endforeach()
file(WRITE ${OUTPUT} "${entries}")

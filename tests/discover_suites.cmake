cmake_minimum_required(VERSION 3.25)
# Registers one ctest entry per GoogleTest suite of a test program, so that the tests of a suite share what they
# compute once. Run after the program is linked:
#   cmake -D NAME=x -D PROGRAM=test_x -D OUTPUT=test_x_suites.cmake -D SLOW=Suite;... -P discover_suites.cmake
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
  string(REGEX REPLACE ".*/([A-Za-z_]+)(/[0-9]+)?$" "\\1" plain "${suite}")
  set(label fast)
  if(suite IN_LIST SLOW OR plain IN_LIST SLOW)
    set(label slow)
  endif()
  string(APPEND entries "add_test([==[${NAME}.${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==] --gtest_brief=1)\n"
                        "set_tests_properties([==[${NAME}.${suite}]==] PROPERTIES LABELS ${label} TIMEOUT 3600)\n")
endforeach()
file(WRITE ${OUTPUT} "${entries}")

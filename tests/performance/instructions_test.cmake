# instructions.cmake fails as it should: with a valgrind that counts what this file tells it to.
cmake_minimum_required(VERSION 3.25)
set(fake ${CMAKE_CURRENT_BINARY_DIR}/fake)
file(MAKE_DIRECTORY ${fake})
file(WRITE ${fake}/valgrind "#!/bin/sh\n")
file(WRITE ${fake}/callgrind_annotate "#!/bin/sh\ncat '${fake}/listing'\n")
file(CHMOD ${fake}/valgrind ${fake}/callgrind_annotate PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
set(ENV{PATH} ${fake}:$ENV{PATH})
set(counts ${fake}/counts.csv)
set(others "build,job,phase,instructions,reason\n\"b\",other,counted,7,\"of another job\"\n")

# run(OUTCOME EXPECTED ARGUMENT...): what the runner says matches, and it fails or does not.
function(run outcome expected)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=p -D JOB=j -D PERCENT=2 -D PHASES=recursive::step,klu_solve -D COUNTS=${counts}
            -D BUILD=b ${ARGN} -P ${CMAKE_CURRENT_LIST_DIR}/instructions.cmake
    WORKING_DIRECTORY ${fake} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")
  if(failed AND outcome STREQUAL "passes" OR NOT failed AND outcome STREQUAL "fails")
    message(SEND_ERROR "not '${outcome}': ${said}")
  endif()
  if(NOT said MATCHES "${expected}")
    message(SEND_ERROR "not '${expected}': ${said}")
  endif()
endfunction()
function(count whole step solve)
  file(WRITE ${fake}/listing
    "${whole} (100.0%)  ???:counted [p]\n"
    "${step} (50.0%)  ???:_ZN11elastocheck9recursive12_GLOBAL__N_14stepIdEEvT_ [p]\n"
    "3 ( 1.0%)  ???:_ZN11elastocheck9recursive4stepEv [p]\n"  # called by the one above
    "9,000 (10.0%)  ???:_ZN11elastocheck9recursive8step_farEv [p]\n"
    "${solve} ( 9.0%)  a/klu.c:klu_solve [/usr/lib/libklu.so]\n")
endfunction()

file(WRITE ${counts} "${others}")
count(1,000,000 500,000 90,000)
run(passes "not judged: nothing is recorded of j for b")
set(ENV{RECORD} ON)
run(fails "set REASON")
set(ENV{REASON} "the first count")
run(passes "j: recorded")
set(ENV{REASON} "no other is needed")
count(1,019,000 505,000 104,000)  # within
run(passes "klu_solve: 90000 recorded, 104000 now")
unset(ENV{RECORD})
run(passes "klu_solve: 90000 recorded, 104000 now")
run(passes "not judged: nothing is recorded of j for c" -D BUILD=c)
file(READ ${counts} table)
set(expected "${others}\"b\",j,counted,1000000,\"the first count\"\n\"b\",j,recursive::step,500000\n\"b\",j,klu_solve,90000\n")
if(NOT table STREQUAL expected)
  message(SEND_ERROR "recorded: ${table}")
endif()
count(1,021,000 501,000 109,000)
run(fails "counted: 1000000 recorded, 1021000 now .21 per mille. klu_solve: [^:]* recursive::step: .* more than 2 % away")
count(979,000 480,000 89,000)
run(fails "counted: 1000000 recorded, 979000 now .-21 per mille. recursive::step: [^:]* klu_solve: .* more than 2 % away")
count(1,000,000 500,000 90,000)
run(fails "phase recursive::gone has no instructions: renamed or inlined" -D PHASES=recursive::gone,klu_solve)
run(fails "phases that are not recorded: recursive::step_far" -D PHASES=recursive::step,recursive::step_far,klu_solve)
file(APPEND ${counts} "${others}")  # rows keep their place
set(ENV{RECORD} ON)
set(ENV{REASON} "another count")
count(1,030,000 530,000 90,000)
run(passes "j: recorded")
file(READ ${counts} table)
string(REPLACE "1000000,\"the first" "1030000,\"another" expected "${expected}${others}")
string(REPLACE "500000" "530000" expected "${expected}")
if(NOT table STREQUAL expected)
  message(SEND_ERROR "recorded: ${table}")
endif()
file(WRITE ${fake}/listing "0  PROGRAM TOTALS\n")
run(fails "phase counted has no instructions")
file(WRITE ${fake}/valgrind "#!/bin/sh\nexit 3\n")
run(fails "failed")

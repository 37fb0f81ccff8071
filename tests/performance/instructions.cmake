# Counts the instructions of JOB of PROGRAM under valgrind and compares them with COUNTS, the committed table: fails
# where the whole differs by more than PERCENT, and lists the PHASES by how far they moved. A phase is a function (in
# elastocheck::, or of C) and all that it calls; one may lie within another. With RECORD in the environment a job that
# would fail is written to COUNTS instead, with REASON from there.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" phases "counted,${PHASES}")  # counted: the whole, in performance.cpp
file(STRINGS ${COUNTS} lines)
set(key "\"${BUILD}\",${JOB},")
set(known FALSE)
set(before "")
set(after "")
foreach(line IN LISTS lines)
  string(FIND "${line}" "${key}" at)
  if(at EQUAL 0)
    string(REPLACE "${key}" "" row "${line}")
    string(REGEX MATCH "^([^,]+),([0-9]+)" row "${row}")
    set(recorded_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
    set(known TRUE)
  elseif(known)
    string(APPEND after "${line}\n")
  else()
    string(APPEND before "${line}\n")
  endif()
endforeach()
if(NOT known AND NOT DEFINED ENV{RECORD})
  message("not judged: nothing is recorded of ${JOB} for ${BUILD}")
  return()
endif()
find_program(VALGRIND valgrind NO_CACHE)  # looked for now: it may be newer than the build
if(NOT VALGRIND)
  message("not judged: valgrind is not installed")
  return()
endif()

# Neither the C library's choice of a processor's variants (0.5 % of the energy leg) nor its look-up of symbols at
# their first call is counted.
set(ENV{GLIBC_TUNABLES} glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512F,-AVX512VL,-FMA,-FMA4,-ERMS,-AVX_Fast_Unaligned_Load)
set(ENV{LD_BIND_NOW} 1)
execute_process(
  COMMAND ${VALGRIND} --quiet --tool=callgrind --callgrind-out-file=${JOB}.callgrind
          --toggle-collect=counted --demangle=no ${PROGRAM} ${JOB}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND callgrind_annotate --inclusive=yes --threshold=100 --auto=no ${JOB}.callgrind
  COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE listing)

set(moves "")
set(rows "")
set(unknown "")
foreach(phase IN LISTS phases)
  if(phase MATCHES "::")  # as the compiler spells it: _ZN11elastocheck9recursive9factoriseI...
    string(REPLACE "::" ";" names "elastocheck::${phase}")
    set(symbol "_ZN")
    foreach(name IN LISTS names)
      string(LENGTH ${name} length)
      string(APPEND symbol "(12_GLOBAL__N_1)?${length}${name}")
    endforeach()
    string(APPEND symbol "[EI]")
  else()
    set(symbol "${phase} ")
  endif()
  # The listing falls: of functions of one name the first is the one that calls the others.
  if(NOT listing MATCHES "([0-9,]+) \\([ 0-9.]+%\\)  [^\n:]*:${symbol}")
    message(FATAL_ERROR "${JOB}: phase ${phase} has no instructions: renamed or inlined. Correct the phases in "
                        "tests/performance/CMakeLists.txt and record again.")
  endif()
  string(REPLACE "," "" count ${CMAKE_MATCH_1})
  string(APPEND rows "${key}${phase},${count}")
  if(phase STREQUAL "counted")
    string(APPEND rows ",\"$ENV{REASON}\"")
  endif()
  string(APPEND rows "\n")
  if(NOT recorded_${phase})
    list(APPEND unknown ${phase})
    continue()
  endif()
  math(EXPR move "${count} - ${recorded_${phase}}")
  math(EXPR permille "1000 * ${move} / ${recorded_${phase}}")
  string(REPLACE "-" "" size ${move})
  list(APPEND moves "${size} ${phase}: ${recorded_${phase}} recorded, ${count} now (${permille} per mille)")
  if(phase STREQUAL "counted")
    math(EXPR allowed "${recorded_counted} * ${PERCENT} / 100")
    set(beyond ${size})
  endif()
endforeach()

set(failed "")
if(unknown)
  set(failed "phases that are not recorded: ${unknown}")
elseif(beyond GREATER allowed)
  set(failed "more than ${PERCENT} % away from what is recorded")
endif()
list(SORT moves COMPARE NATURAL ORDER DESCENDING)
list(TRANSFORM moves REPLACE "^[0-9]+ " "  ")
list(JOIN moves "\n" moves)
message("${JOB}, ${PERCENT} % allowed on all that is counted; largest move first:\n${moves}")
if(NOT failed)
  return()
endif()
if(NOT DEFINED ENV{RECORD})
  message(FATAL_ERROR "${JOB}: ${failed}. More is a regression. Less, or meant: REASON='why' cmake --build --preset "
                      "release --target record_instructions, and commit tests/performance/instructions.csv.")
endif()
if(NOT "$ENV{REASON}" MATCHES "^[^][;\"]+$")
  message(FATAL_ERROR "${JOB}: set REASON in the environment to why the count is another, without brackets, semicolons "
                      "and quotation marks")
endif()
file(WRITE ${COUNTS} "${before}${rows}${after}")
message("${JOB}: recorded")

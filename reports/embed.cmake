# Writes OUTPUT: FILES under FOLDER by their names without SUFFIX, as text in the program: embedded_WHAT. The list is
# part of the command, so that a file that comes or goes is noticed however old it is.
cmake_minimum_required(VERSION 3.25)
set(entries "")
foreach(file IN LISTS FILES)
  file(READ ${file} text)
  file(RELATIVE_PATH name ${FOLDER} ${file})
  string(REGEX REPLACE "\\.${SUFFIX}$" "" name ${name})
  string(APPEND entries "    {\"${name}\", R\"~~~~(${text})~~~~\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "#pragma once
#include <string_view>
namespace elastocheck {
struct Embedded_@WHAT@ { std::string_view name, text; };
inline constexpr Embedded_@WHAT@ embedded_@WHAT@[] = {
@entries@};
}
")

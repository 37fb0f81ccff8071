# Writes the header OUTPUT with embedded_WHAT: the texts of FILES by their names under FOLDER without SUFFIX. The list of
# files is part of the command, so that OUTPUT is made again when a file is added or removed.
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

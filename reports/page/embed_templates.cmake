# Writes OUTPUT: the templates FILES under FOLDER by their names, as text in the program. The list is part of the
# command, so that a file that comes or goes is noticed however old it is.
cmake_minimum_required(VERSION 3.25)
set(entries "")
foreach(file IN LISTS FILES)
  file(READ ${file} text)
  file(RELATIVE_PATH name ${FOLDER} ${file})
  string(REGEX REPLACE "\\.mustache$" "" name ${name})
  string(APPEND entries "    {\"${name}\", R\"~~~~(${text})~~~~\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "#pragma once
#include <string_view>
namespace elastocheck::reports {
struct EmbeddedTemplate { std::string_view name, text; };
inline constexpr EmbeddedTemplate embedded_templates[] = {
@entries@};
}
")

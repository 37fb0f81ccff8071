# Writes OUTPUT: every *.mustache under FOLDER by its name, as text in the program.
cmake_minimum_required(VERSION 3.25)
file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*.mustache)
list(SORT files)
set(entries "")
foreach(file IN LISTS files)
  file(READ ${FOLDER}/${file} text)
  string(REGEX REPLACE "\\.mustache$" "" name ${file})
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

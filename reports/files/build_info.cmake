# Run at every build: writes the version, commit, compiler and libraries to OUTPUT, if they changed. In an archive by
# `git archive` (.gitattributes) git has written the commit below; a checkout that has the sources in a subfolder is
# another project's and is ignored.
find_package(Git QUIET)
set(commit "$Format:%H$")
if(commit MATCHES "Format")
  set(commit "unknown")
endif()
set(dirty "false")
if(GIT_FOUND)
  # In a container the checkout often belongs to another user.
  set(git ${GIT_EXECUTABLE} -c safe.directory=* -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --show-prefix HEAD
                  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  # The first line is the folder within the checkout, empty at its top: only then the commit alone is left.
  string(STRIP "${head}" head)
  if(NOT failed AND head MATCHES "^[0-9a-f]+$")
    set(commit ${head})
    execute_process(COMMAND ${git} status --porcelain --untracked-files=no
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      set(dirty "true")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once
namespace elastocheck::reports::build_info {
inline constexpr const char* version = "@VERSION@";
inline constexpr const char* commit = "@commit@";
inline constexpr bool dirty = @dirty@;
inline constexpr const char* compiler = "@COMPILER@";
inline constexpr const char* flags = "@FLAGS@";
struct NameVersion { const char *name, *version; };
inline constexpr NameVersion libraries[] = {
    {"Eigen", "@EIGEN@"}, {"Ceres", "@CERES@"}, {"NLopt", "@NLOPT@"}, {"yaml-cpp", "@YAML@"}, {"fmt", "@FMT@"}};
inline constexpr NameVersion without_arithmetic[] = {
    {"CLI11", "@CLI11@"}, {"nlohmann-json", "@JSON@"}};
}
]])

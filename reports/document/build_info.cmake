# Run at every build: writes OUTPUT from what git says now, and leaves it alone when nothing changed.
find_package(Git QUIET)
set(commit "unknown")
set(dirty "false")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE} rev-parse HEAD
                  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${head})
    execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE} status --porcelain --untracked-files=no
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
}
]])

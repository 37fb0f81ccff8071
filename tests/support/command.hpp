// A command as a user runs it: exit code, output, errors.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "tests/support/folder.hpp"

namespace elastocheck::support {

struct Said {
    int code = -1;  // -1: killed
    std::string out, err;
};

// Runs a line of shell.
inline Said says(const std::string& line) {
    const Folder folder;
    const std::string error = (folder.path / "err").string();
    FILE* pipe = ::popen((line + " 2>" + error).c_str(), "r");
    Said said;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
        said.out.append(buffer, n);
    const int status = ::pclose(pipe);
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    said.err = text_of(error);
    return said;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace elastocheck::support

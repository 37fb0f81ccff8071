// Running a program as a user does.
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

// `command` is a line for the shell.
inline Said run(const std::string& command) {
    const Folder folder;
    const std::string error = (folder.path / "err").string();
    FILE* pipe = ::popen((command + " 2>" + error).c_str(), "r");
    Said said;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) said.out.append(buffer, n);
    const int status = ::pclose(pipe);
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    said.err = text_of(error);
    return said;
}

}  // namespace elastocheck::support

// Runs a command as a user does and checks its exit code, output and errors.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <source_location>
#include <string>
#include <vector>

#include "tests/support/folder.hpp"

namespace elastocheck::support {

struct RunResult {
    int code = -1;  // -1: killed
    std::string out, err;
};

// Runs a command line by the shell.
inline RunResult shell(const std::string& line) {
    const Folder folder;
    const std::string error = (folder.path / "err").string();
    FILE* pipe = ::popen((line + " 2>" + error).c_str(), "r");
    RunResult said;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
        said.out.append(buffer, n);
    const int status = ::pclose(pipe);
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    said.err = text_of(error);
    return said;
}

// Exit code 0 if the files are well-formed XML.
inline RunResult read_xml(const std::string& files) {
    return shell(
        "python3 -c 'import sys, xml.sax; [xml.sax.parse(f, xml.sax.ContentHandler()) for f in "
        "sys.argv[1:]]' " +
        files);
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Expects that a text has all of `parts` and none of `absent`. A failure shows the text.
inline void expect_parts(const std::string& text, const std::vector<std::string>& parts,
                         const std::vector<std::string>& absent = {},
                         std::source_location at = std::source_location::current()) {
    std::string wrong;
    for (const auto& part : parts)
        if (!contains(text, part)) wrong += "missing: " + part + "\n";
    for (const auto& part : absent)
        if (contains(text, part)) wrong += "unwanted: " + part + "\n";
    if (!wrong.empty())
        ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << wrong << "---- in\n" << text;
}

// Parts that the output and the errors of a command must have, and those that they must not have.
struct Parts {
    std::vector<std::string> out = {}, err = {}, not_out = {}, not_err = {};
};

// Expects the exit code and the parts. A failure shows the whole output.
inline RunResult expect_result(RunResult said, int code, const Parts& parts = {},
                               std::source_location at = std::source_location::current()) {
    std::string wrong;
    if (said.code != code)
        wrong = "exit code " + std::to_string(said.code) + ", not " + std::to_string(code) + "\n";
    const auto look = [&](const std::string& text, const std::vector<std::string>& list, bool in) {
        for (const auto& part : list)
            if (contains(text, part) != in)
                wrong += (in ? "missing: " : "unwanted: ") + part + "\n";
    };
    look(said.out, parts.out, true);
    look(said.err, parts.err, true);
    look(said.out, parts.not_out, false);
    look(said.err, parts.not_err, false);
    if (!wrong.empty())
        ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << wrong << "---- output\n"
                                                                    << said.out << "---- errors\n"
                                                                    << said.err;
    return said;
}

}  // namespace elastocheck::support

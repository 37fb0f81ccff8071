// Runs another program: without a shell, in its own process group, for a limited time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// Splits "./my solver' 1' {scene} --n {steps}" into words: separated by blanks, grouped by '...'
// and "...", a backslash escapes the next character (not between '...'). Throws
// std::invalid_argument for an unclosed quote.
std::vector<std::string> words_of(std::string_view line);

struct ProcessResult {
    enum class How {
        by_itself,   // it returned an exit code
        by_signal,   // a signal ended it
        too_long,    // it ran longer than the limit, and was killed
        not_started  // the system could not run it
    } how = How::by_itself;
    int code = 0;             // exit code, signal, or errno
    std::string output_text;  // last part of its standard error and output

    bool succeeded() const { return how == How::by_itself && code == 0; }
};
// "ended with exit code 2", "was killed by signal 11 (Segmentation fault)", "took longer than 60 s
// and was killed"
std::string describe(const ProcessResult& result, double limit);

// Runs the program with empty standard input. When it ends, or after `limit` seconds, the rest of
// its process group is killed. Not from several threads at once.
ProcessResult run(const std::vector<std::string>& words, double limit);

// Installs a handler for SIGINT, SIGTERM, SIGHUP and SIGQUIT, unless ignored: kills the process
// group of a running program and ends this one by the signal's default action.
void end_child_on_signals();

// A new folder in $TMPDIR or in /tmp, removed by its destructor; if a signal or a crash ended the
// program, by the next one that makes such a folder. Throws FileError.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace elastocheck::reports

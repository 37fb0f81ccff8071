// A program of somebody else's, run: no shell, in a process group of its own, for so long and no longer.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// "./my solver' 1' {scene} --n {steps}" as words: blanks part them, '...' and "..." keep them together, a backslash takes the
// next character as it is (not between '...'). Throws std::invalid_argument for a quote that does not close.
std::vector<std::string> words_of(std::string_view line);

struct Ended {
    enum class How { by_itself, by_signal, too_long, not_started } how = How::by_itself;
    int code = 0;        // exit code, signal, or errno
    std::string said;    // the end of what it wrote to standard error and output
    double seconds = 0;  // of a clock
    double cpu = 0;      // of the program and those that it waited for

    bool well() const { return how == How::by_itself && code == 0; }
};
// "ended with exit code 2", "was killed by signal 11 (Segmentation fault)", "took longer than 60 s and was killed"
std::string describe(const Ended& ended, double limit);

// Standard input is empty. What is left of its process group when it ends, or when `limit` seconds are over, is killed.
Ended run(const std::vector<std::string>& words, double limit);

// A folder of one's own that is gone with its owner.
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

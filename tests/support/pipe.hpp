// Test fixture: a named pipe without a writer. After two seconds a reader that waits reads the end of the file.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>
#include <utility>

namespace elastocheck::support {

class Pipe {
  public:
    explicit Pipe(std::filesystem::path path) : path_(std::move(path)) {
        made_ = ::mkfifo(path_.c_str(), 0600) == 0;
        end_ = std::thread([this] {
            for (int k = 0; k < 200 && !done_; ++k) ::usleep(10'000);
            if (const int out = ::open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC); out >= 0)
                ::close(out);
        });
    }
    ~Pipe() {
        done_ = true;
        end_.join();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    bool is_there() const { return made_; }

  private:
    std::filesystem::path path_;
    bool made_ = false;
    std::atomic<bool> done_ = false;
    std::thread end_;
};

}  // namespace elastocheck::support

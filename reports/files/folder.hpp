// A folder of files is replaced in one step: at any moment it is the old one or the new one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/files/files.hpp"

namespace elastocheck::reports {

// The new folder while it is being filled, beside the one it will replace. One that is not published is
// removed.
class Staging {
  public:
    // Throws FileError when `folder` is a file, or holds anything that is not listed in its own `manifest`:
    // nobody's files but our own are ever replaced.
    explicit Staging(const std::filesystem::path& folder);
    static void check(const std::filesystem::path& folder);  // only that
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    const std::filesystem::path& path() const { return staging_; }

    // Writes the manifest and puts the new folder in the place of the old one. Throws FileError; the old one
    // is then untouched.
    void publish();

  private:
    std::filesystem::path target_, staging_;
    int lock_ = -1;  // held on the staging folder while its owner lives
};

inline constexpr const char* manifest = "files.txt";  // what a folder holds, a path a line

}  // namespace elastocheck::reports

// Atomic replacement of a folder of files: at any moment it is the old one or the new one.
//
// The `manifest` of a folder lists its files. A folder is replaced only if every file in it is on
// its manifest, so that no file of another program is deleted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/files/files.hpp"

namespace elastocheck::reports {

inline constexpr const char* manifest = "files.txt";
// its first line; then a path on each line
inline constexpr const char* manifest_head = "elastocheck files 1";

// Staging folder: the new folder while it is written, beside the one that it replaces. It is removed
// unless published; after a signal or a crash, by the next run that writes this folder.
class Staging {
  public:
    // Throws FileError when `folder` is a file, or holds a file that is not on its manifest.
    explicit Staging(const std::filesystem::path& folder);
    static void check(const std::filesystem::path& folder);  // the check alone
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    const std::filesystem::path& path() const { return staging_; }

    // Writes the manifest and replaces the old folder, which is untouched on a FileError.
    void publish();

  private:
    std::filesystem::path target_, staging_;
};

// A whole folder in one step: names and contents of its files.
struct NamedContent {
    std::string name, content;
};
void write_folder(const std::filesystem::path& folder, const std::vector<NamedContent>& files);

}  // namespace elastocheck::reports

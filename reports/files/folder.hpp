// A folder of files is replaced in one step: at any moment it is the old one or the new one.
//
// What a folder holds stands in its `manifest`, each file with a hash of its content. Only a folder whose
// every file is on its own manifest, as it was written, is ever replaced: nobody's files but our own are
// deleted, nor what somebody made of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/files/files.hpp"

namespace elastocheck::reports {

inline constexpr const char* manifest = "files.txt";
inline constexpr const char* manifest_head = "elastocheck files 1";  // its first line; then "HASH  PATH"

// The new folder while it is being filled, beside the one it will replace. One that is not published is
// removed.
class Staging {
  public:
    // Throws FileError when `folder` is a file, or holds anything that cannot be shown to be ours.
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

// A whole folder in one step: of every file its name and content.
struct NamedContent {
    std::string name, content;
};
void write_folder(const std::filesystem::path& folder, const std::vector<NamedContent>& files);

}  // namespace elastocheck::reports

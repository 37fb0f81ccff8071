// Files are written whole or not at all.
#include "reports/files/files.hpp"

#include <gtest/gtest.h>

#include "tests/support/folder.hpp"

namespace elastocheck::reports {
namespace {

using support::Folder;
using support::text_of;

int entries(const std::filesystem::path& folder) {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WriteWhole, MakesTheFolderAndReplacesAnOlderFile) {
    const Folder folder;
    const auto file = folder.path / "new" / "deep" / "result.json";
    write_whole(file, "one");
    write_whole(file, std::string(3'000'000, 'x'));
    EXPECT_EQ(text_of(file).size(), 3'000'000u);
    write_whole(file, "");
    EXPECT_EQ(text_of(file), "");
    EXPECT_EQ(entries(file.parent_path()), 1);
}

TEST(WriteWhole, LeavesNothingBehindWhereItCannotWrite) {
    const Folder folder;
    folder.write("file", "old");
    EXPECT_THROW(write_whole(folder.path / "file" / "result.json", "x"), FileError);
    std::filesystem::create_directory(folder.path / "taken");
    std::filesystem::create_directory(folder.path / "taken" / "inside");
    try {
        write_whole(folder.path / "taken", "x");
        ADD_FAILURE() << "a folder was overwritten";
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("taken: cannot be written"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(entries(folder.path), 2);
    EXPECT_THROW(write_whole("/dev/full/result.json", "x"), FileError);
}

}  // namespace
}  // namespace elastocheck::reports

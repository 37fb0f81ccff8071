// Facts about scenes that come from other programs' files, in facts/*.facts: of a sample, of mistakes/linkage.adm,
// and of fixtures/beside_files.yaml with what it names.
#include "tests/models/facts.hpp"

#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using namespace tests;
namespace fs = std::filesystem;

class ImportFacts : public testing::TestWithParam<ReadClaim> {};

TEST_P(ImportFacts, Hold) {
    for (const char* place : {"samples", "mistakes", "fixtures"})
        for (const std::string ending : {".json", ".adm", ".yaml"}) {
            const fs::path file = import_folder / place / (GetParam().file + ending);
            if (!exists(file)) continue;
            const support::Folder beside;
            fs::copy(file.parent_path(), beside.path);
            const auto read = [&](const std::string& text, const std::vector<Setting>& set) {
                if (ending == ".yaml") return read_scene(beside.write("s.yaml", text), set);
                const auto imported = importer::import_text(text, "model" + ending, {});
                return parse_scene(imported.yaml, "scene", set);
            };
            expect_facts(GetParam(), support::text_of(file), read, false);
            return;
        }
    FAIL() << "no text of " << GetParam().file;
}
INSTANTIATE_TEST_SUITE_P(Files, ImportFacts,
                         testing::ValuesIn(claims_beside(import_folder / "facts")), name_of);

}  // namespace
}  // namespace elastocheck

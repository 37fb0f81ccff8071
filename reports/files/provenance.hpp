// Provenance of a result: code version, build and machine.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

struct Library {
    std::string name, version;
};

struct Provenance {
    std::string version;   // of elastocheck
    std::string commit;    // full hash, "unknown" outside a git checkout
    bool dirty = false;    // uncommitted changes in the checkout it was built from
    std::string compiler;  // "GNU 12.2.0"
    std::string flags;     // "-O3 -DNDEBUG -ffp-contract=off"
    std::string cpu;       // model name, "unknown" if the system does not report it
    std::vector<Library> libraries;
};

Provenance provenance();

// Output of --version: version, commit, compiler, and all libraries, also those without arithmetic.
std::string version_text(const Provenance& provenance);

// The same in a result or a baseline.
nlohmann::ordered_json provenance_json(const Provenance& provenance);

// FNV-1a, 64 bit, in hex: detects different inputs; not cryptographic.
std::string input_hash(std::string_view content);

}  // namespace elastocheck::reports

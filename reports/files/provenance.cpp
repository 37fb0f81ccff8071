#include "reports/files/provenance.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>

#include "build_info.hpp"  // generated: commit, dirty, compiler, flags, library versions

namespace elastocheck::reports {

Provenance provenance() {
    Provenance p;
    p.version = build_info::version;
    p.commit = build_info::commit;
    p.dirty = build_info::dirty;
    p.compiler = build_info::compiler;
    p.flags = build_info::flags;
    p.cpu = "unknown";
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            p.cpu = line.substr(colon + 2);
            break;
        }
    }
    for (const auto& [name, version] : build_info::libraries)
        p.libraries.push_back({name, version});
    return p;
}

std::string version_text(const Provenance& p) {
    std::string libraries;
    const auto add = [&](const std::string& name, const std::string& version) {
        libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", name, version);
    };
    for (const auto& library : p.libraries) add(library.name, library.version);
    for (const auto& [name, version] : build_info::without_arithmetic) add(name, version);
    return fmt::format("elastocheck {}\ncommit {}{}\ncompiler {}, {}\nlibraries {}", p.version,
                       p.commit, p.dirty ? ", with uncommitted changes" : "", p.compiler, p.flags,
                       libraries);
}

nlohmann::ordered_json provenance_json(const Provenance& p) {
    nlohmann::ordered_json libraries = nlohmann::ordered_json::object();
    for (const auto& library : p.libraries) libraries[library.name] = library.version;
    return {{"elastocheck", p.version}, {"commit", p.commit}, {"dirty", p.dirty},
            {"compiler", p.compiler},   {"flags", p.flags},   {"cpu", p.cpu},
            {"libraries", libraries}};
}

std::string input_hash(std::string_view content) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return fmt::format("{:016x}", hash);
}

}  // namespace elastocheck::reports

// The solver of a live page, run natively: prints what the page gets for a scene, for the comparison with WebAssembly.
// native SCENE [PATH=VALUE ...]; one JSON object: open, head, numbers as text of 17 digits; compliance; proof of the
// first three points of the last branch.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "models/reader/document/text_file.hpp"
#include "reports/live/compliance.hpp"
#include "reports/live/engine.hpp"
#include "reports/live/proof.hpp"

int main(int count, char** words) {
    using namespace elastocheck;
    if (count < 2) return 2;
    try {
        live::Session session;
        const auto file = reader::read_text(words[1], reader::Pipes::allowed);
        nlohmann::ordered_json result;
        result["open"] = live::open(session, file.text, "scene.yaml",
                                    std::filesystem::path(words[1]).parent_path());
        live::Request request;
        for (int k = 2; k < count; ++k) request.settings.push_back(parse_setting(words[k]));
        request.published = true;
        const live::Answer answer = live::solve(session, request);
        result["head"] = answer.head;
        result["numbers"] = nlohmann::ordered_json::array();
        for (const double x : answer.numbers)
            result["numbers"].push_back(fmt::format("{:.17g}", x));
        if (!answer.head.contains("trouble") && !result["open"]["branches"].empty()) {
            result["compliance"] = live::compliance(session, request.settings);
            request.only = result["open"]["branches"].back()["name"];
            result["proof"] = live::prove(session, request, 0, 3);
        }
        std::puts(result.dump().c_str());
    } catch (const std::exception& error) {
        std::puts(nlohmann::ordered_json{{"error", error.what()}}.dump().c_str());
    }
    return 0;
}

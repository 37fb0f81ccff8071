// A scene that is read many times with other values of its numbers: its text is parsed once, which
// is most of the time of read_scene().
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/model.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/one_side.hpp"
#include "models/reader/plausibility.hpp"

namespace elastocheck::reader {

class ParsedScene {
  public:
    // `folder` is that of the scene's file, for the files that it refers to. Throws SceneError for
    // text that is not YAML.
    ParsedScene(std::string_view text, std::string name, Folder folder);
    // Of a file. Throws SceneError if it cannot be read.
    explicit ParsedScene(const std::filesystem::path& file);

    // As read_whole() of the text; `warnings` null: not looked for. Throws SceneError. Thread-safe.
    Scene read(std::span<const Setting> settings,
               std::vector<std::string>* warnings = nullptr) const;
    std::vector<RequestedDefinition> definitions(std::span<const Setting> settings) const;

  private:
    friend class VariedScene;
    Value tree_;
    std::string name_;
    Folder folder_;
};

// A scene that is read again at other values of the same numbers, in a fraction of the time: what does
// not depend on numbers is not checked again, and the scene has no list of its numbers.
// Pre: the scene has been read.
class VariedScene {
  public:
    // `paths`: the numbers that vary; `settings`: of other values, the same at each reading. Throws
    // SceneError for a path that is not one of a value, or is given twice.
    VariedScene(const ParsedScene& scene, std::vector<std::string> paths,
                std::vector<Setting> settings = {});
    // The values in the units of the file. `model`: the scene compiled, where its reader did that.
    // Throws SceneError, as ParsedScene::read().
    Scene read(std::span<const double> values, std::optional<Model>* model = nullptr);

  private:
    const ParsedScene& scene_;
    std::vector<Setting> settings_;            // then those of the paths
    std::vector<std::vector<Value*>> places_;  // of each path; two where it is of both sides
    Trees trees_;
};

}  // namespace elastocheck::reader

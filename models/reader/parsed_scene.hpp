// A scene that is read many times with other values of its numbers. Its text is parsed once; parsing
// takes most of the time of read_scene().
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
    // `folder`: that of the files to which the text refers. Throws SceneError for text that is not YAML.
    ParsedScene(std::string_view text, std::string name, Folder folder);
    // Throws SceneError for a file that cannot be read or is not YAML.
    explicit ParsedScene(const std::filesystem::path& file);

    // As parse_scene_with_warnings() of the text. With `warnings` null the plausibility checks are left out. Throws
    // SceneError. Thread-safe.
    Scene read(std::span<const Setting> settings,
               std::vector<std::string>* warnings = nullptr) const;
    std::vector<RequestedDefinition> definitions(std::span<const Setting> settings) const;

  private:
    friend class VariedScene;
    Value tree_;
    std::string name_;
    Folder folder_;
};

// A scene that is read again and again at other values of the same numbers, in a fraction of the time: what
// does not depend on numbers is not checked, and Scene::numbers stays empty. Pre: the scene has been read.
class VariedScene {
  public:
    // `paths`: the numbers that vary; `settings`: other values, the same at each reading. Throws
    // SceneError for a path that does not lead to one value, or is given twice.
    VariedScene(const ParsedScene& scene, std::vector<std::string> paths,
                std::vector<Setting> settings = {});
    // `values`, one per path, are in the units of the file. `model` receives the compiled scene, unless a
    // trim or another side is still to change it. Throws SceneError, as ParsedScene::read().
    Scene read(std::span<const double> values, std::optional<Model>* model = nullptr);

  private:
    const ParsedScene& scene_;
    std::vector<Setting> settings_;  // the constant ones, then one per path
    std::vector<std::vector<Value*>>
        places_;  // in trees_, of each path; two if it is of both sides
    Trees trees_;
};

}  // namespace elastocheck::reader

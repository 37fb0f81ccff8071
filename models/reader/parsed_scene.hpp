// A scene that is read many times with other values of its numbers: its text is parsed once, which
// is most of the time of read_scene().
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/plausibility.hpp"

namespace elastocheck::reader {

class ParsedScene {
  public:
    // `folder` is that of the scene's file, for the files that it refers to. Throws SceneError for
    // text that is not YAML.
    ParsedScene(std::string_view text, std::string name, Folder folder);

    // As read_whole() of the text; without `warnings` nothing is checked for them. Throws SceneError.
    // Thread-safe.
    Scene read(std::span<const Setting> settings,
               std::vector<std::string>* warnings = nullptr) const;
    std::vector<RequestedDefinition> definitions(std::span<const Setting> settings) const;

  private:
    Value tree_;
    std::string name_;
    Folder folder_;
};

}  // namespace elastocheck::reader

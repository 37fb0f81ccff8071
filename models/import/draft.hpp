// Draft of an imported scene: its entries as text, each with its source line.
// Entries are in the order of the source file. One writer serves all formats.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer {

// Source line and statement: "line 80, JOINT/1 'knuckle'".
struct SourceLocation {
    int line = 0;
    std::string what;
    std::string file = {};  // if it is not the draft's source
};

// ---- Words.

// The text with each occurrence of the word replaced.
std::string replaced(std::string text, std::string_view word, std::string_view by);
// The pieces between the separators, trimmed.
std::vector<std::string> split(std::string_view text, std::string_view separator);

// Characters that are not printable ASCII replaced by '?'.
std::string printable(std::string_view text);

// "1 point", "2 points", "3 bodies"; keywords in capitals have no plural: "2 MARKER".
std::string counted(int n, const std::string& kind);

// ---- Numbers and fields in the format of a scene.

std::string number(double x);  // the shortest text that reads back as x
// A calculated number: twelve digits, and 0 below 1e-12 of `scale`.
std::string computed(double x, double scale = 1);
std::string triple(const Eigen::Vector3d& v, double scale = 1);  // "[1, 2, 3]", computed
std::string direction(const Eigen::Vector3d& u);                 // "x", "-y", "[0.6, 0, 0.8]"
// "{table: [[x, f], ...]}"; `linear`: with straight lines between the rows.
std::string curve_of_rows(const std::vector<std::pair<double, double>>& rows, bool known_outside,
                          bool linear = false);

// The fields of an entry, "type: revolute, at: hinge".
class Fields {
  public:
    Fields& add(std::string_view key, std::string_view value);
    Fields& add(std::string_view key, double value) { return add(key, number(value)); }
    Fields& add(const Fields& more);
    const std::string& text() const { return text_; }
    std::string braced() const { return "{" + text_ + "}"; }

  private:
    std::string text_;
};

struct Entry {
    std::string name, fields;
    SourceLocation from;
};

// ---- Names: of characters allowed in a scene, unique in their section.

class Names {
  public:
    std::string take(std::string_view wanted);  // the closest name that is allowed and unused

  private:
    std::set<std::string> taken_;
    std::unordered_map<std::string, int> last_;
};

// Hardpoints: at() returns the name of the hardpoint at this position, within 1e-9 of the model's size,
// and adds it where there is none; add() always adds one.
class Hardpoints {
  public:
    explicit Hardpoints(double size = 1) : size_(size) {}
    std::string at(const Eigen::Vector3d& position, std::string_view wanted,
                   const SourceLocation& from);
    void add(const Eigen::Vector3d& position, std::string_view wanted, const SourceLocation& from);
    const std::vector<Entry>& entries() const { return entries_; }
    std::vector<Entry>& entries() { return entries_; }
    const std::vector<Eigen::Vector3d>& positions() const { return positions_; }

  private:
    double size_;
    Names names_;
    std::vector<Entry> entries_;
    std::vector<Eigen::Vector3d> positions_;
    std::multimap<double, std::size_t> by_projection_;  // positions, for at()
};

// ---- Notes in the head of the scene and in the output of the command.

struct Notes {
    std::map<std::string, int> understood;  // "JOINT" -> 12
    // reason -> parts without effect in statics
    std::map<std::string, std::vector<SourceLocation>> omitted;
    std::vector<std::pair<SourceLocation, std::string>> warnings;
    // parts with an effect in statics that the scene cannot represent
    std::vector<std::pair<SourceLocation, std::string>> missing;
    std::vector<std::pair<std::string, SourceLocation>> roles;  // of a mechanism, and their points

    void count(const std::string& kind) { ++understood[kind]; }
    void leave_out(const std::string& why, SourceLocation what) {
        omitted[why].push_back(std::move(what));
    }
    void warn(SourceLocation at, std::string what) {
        warnings.emplace_back(std::move(at), std::move(what));
    }
    void miss(SourceLocation at, std::string what) {
        missing.emplace_back(std::move(at), std::move(what));
    }
};

struct Draft {
    std::string title;                  // of the scene
    std::string source;                 // the file, as given by the user
    std::string format;                 // "ADAMS dataset"
    std::vector<std::string> remarks;   // for the head: units, axes
    std::string units;                  // "{length: mm, angle: rad, force: N}"
    std::optional<std::string> mirror;  // "left -> right"
    Hardpoints points{1};
    std::optional<Eigen::Vector3d> gravity;  // [m/s²]
    std::vector<Entry> bodies, joints, bushings, springs, stops, torsion_springs, static_loads,
        loads, branches, wheels, probes, dampers;
    Notes notes;

    // The sections that follow the points, in their order in the file.
    std::vector<std::pair<const char*, std::vector<Entry>*>> sections();
};

// The text of the scene for the ordinary reader. `line_of[n]` is the source of the scene's line n + 1.
struct Text {
    std::string yaml;
    std::vector<SourceLocation> line_of;

    void add_line(const std::string& line, const SourceLocation& from = {}) {
        yaml += line + "\n";
        line_of.push_back(from);
    }
};
Text write(Draft& draft);

// Text as comment lines of a scene, wrapped, each with "# " and a line end.
std::string commented(std::string_view what);

// The notes as lines of text, for the head of the scene and the output of the command; without comment marks.
std::vector<std::string> described(const Notes& notes);

}  // namespace elastocheck::importer

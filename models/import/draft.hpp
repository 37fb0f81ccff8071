// What an importer understood, on its way to the text of a scene: entries as a person would write them, in the order of the
// file they come from, each with the place it came from. One writer for all formats.
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

namespace elastocheck::importer {

// A line of a file, and what stands there: "line 80, JOINT/1 'knuckle'".
struct Place {
    int line = 0;
    std::string what;
};

// ---- Numbers and fields as they stand in a scene.

std::string number(double x);  // the shortest text that reads back as x
std::string computed(double x,
                     double scale = 1);  // twelve digits, and nothing below 1e-12 of scale: x was calculated
std::string triple(const Eigen::Vector3d& v, double scale = 1);  // "[1, 2, 3]", computed
std::string direction(const Eigen::Vector3d& u);                 // "x", "-y", "[0.6, 0, 0.8]"
std::string table(const std::vector<std::pair<double, double>>& rows);

// The fields of an entry, "type: revolute, at: hinge".
class Fields {
  public:
    Fields& add(std::string_view key, std::string_view value);
    Fields& add(std::string_view key, double value) { return add(key, number(value)); }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

struct Entry {
    std::string name, fields;
    Place from;
};

// ---- Names: of a scene's letters, each once in its section.

class Names {
  public:
    std::string take(std::string_view wanted);  // the nearest that is allowed and free

  private:
    std::set<std::string> taken_;
    std::unordered_map<std::string, int> last_;
};

// Hardpoints: one name for each position, to 1e-9 of the model's size.
class Hardpoints {
  public:
    explicit Hardpoints(double size = 1) : size_(size) {}
    std::string at(const Eigen::Vector3d& position, std::string_view wanted, const Place& from);
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    double size_;
    Names names_;
    std::vector<Entry> entries_;
    std::vector<Eigen::Vector3d> positions_;
    std::multimap<double, std::size_t> by_x_;
};

// ---- What is told in the head of the scene, and by the command.

struct Notes {
    std::map<std::string, int> understood;               // "JOINT" -> 12
    std::map<std::string, std::vector<Place>> left_out;  // why -> what: it has no static meaning
    std::vector<std::pair<Place, std::string>> warnings;
    std::vector<std::pair<Place, std::string>> missing;  // it has a static meaning, and the scene has it not

    void count(const std::string& kind) { ++understood[kind]; }
    void leave_out(const std::string& why, Place what) { left_out[why].push_back(std::move(what)); }
    void warn(Place at, std::string what) { warnings.emplace_back(std::move(at), std::move(what)); }
    void miss(Place at, std::string what) { missing.emplace_back(std::move(at), std::move(what)); }
};

struct Draft {
    std::string title;                  // of the scene
    std::string source;                 // the file, as the user named it
    std::string format;                 // "ADAMS dataset"
    std::vector<std::string> remarks;   // on the head: units, axes
    std::string units;                  // "{length: mm, angle: rad, force: N}"
    std::optional<std::string> mirror;  // "left -> right"
    Hardpoints points{1};
    std::optional<Eigen::Vector3d> gravity;  // [m/s²]
    std::vector<Entry> bodies, joints, bushings, springs, stops, torsion_springs, static_loads, loads,
        branches, wheels, probes, dampers;
    Notes notes;
};

// The text of the scene, read by the ordinary reader. `line_of[n]` is the line of the source of the scene's line n + 1.
struct Text {
    std::string yaml;
    std::vector<Place> line_of;
};
Text write(const Draft& draft);

// What the head of the scene says of the notes, and the command after it; a line each, without a mark before it.
std::vector<std::string> told(const Notes& notes);

}  // namespace elastocheck::importer

// Functions that the page calls, on flat memory. A call leaves its answer in `text` and `numbers`, which stay valid until
// the next one; a call that throws ends the instance (throw.cpp).
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "reports/live/compliance.hpp"
#include "reports/live/engine.hpp"
#include "reports/live/proof.hpp"
#include "reports/live/wishes.hpp"

namespace elastocheck::live {
extern std::string name_of_scene;                 // throw.cpp
extern std::map<std::string, std::string> files;  // files.cpp

namespace {
Session session;
std::string text;
std::vector<double> numbers;

std::string_view view(const char* first, std::size_t size) { return {first, size}; }
}  // namespace
}  // namespace elastocheck::live

using namespace elastocheck::live;

extern "C" {

[[clang::export_name("reserve")]] char* reserve(std::size_t size) {
    return static_cast<char*>(std::malloc(size + 1));
}
[[clang::export_name("release")]] void release(char* at) { std::free(at); }

// A file that the scene to be opened refers to by this name.
[[clang::export_name("file")]] void live_file(const char* name, std::size_t name_size,
                                              const char* content, std::size_t size) {
    files.insert_or_assign(std::string(view(name, name_size)), std::string(view(content, size)));
}
[[clang::export_name("open")]] void live_open(const char* scene, std::size_t size, const char* name,
                                              std::size_t name_size) {
    name_of_scene = view(name, name_size);
    const auto folder = files.empty() ? std::nullopt : elastocheck::reader::Folder("");
    text = open(session, view(scene, size), name_of_scene, folder).dump();
}
[[clang::export_name("solve")]] void live_solve(const char* request, std::size_t size) {
    Answer answer = solve(session, request_of(view(request, size)));
    text = answer.head.dump();
    numbers = std::move(answer.numbers);
}
[[clang::export_name("rewrite")]] void live_rewrite(const char* request, std::size_t size) {
    text = rewrite(session, request_of(view(request, size)).settings);
}
[[clang::export_name("prove")]] void live_prove(const char* request, std::size_t size, int first,
                                                int count) {
    text = prove(session, request_of(view(request, size)), first, count).dump();
}
[[clang::export_name("compliance")]] void live_compliance(const char* request, std::size_t size) {
    text = compliance(session, request_of(view(request, size)).settings).dump();
}
[[clang::export_name("wish")]] void live_wish(const char* request, std::size_t size) {
    text = wish(session, view(request, size)).dump();
}
[[clang::export_name("text")]] const char* text_at() { return text.data(); }
[[clang::export_name("text_size")]] std::size_t text_size() { return text.size(); }
[[clang::export_name("numbers")]] const double* numbers_at() { return numbers.data(); }
[[clang::export_name("numbers_size")]] std::size_t numbers_size() { return numbers.size(); }
}

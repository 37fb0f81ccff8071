// Functions that the page calls, on flat memory. A call leaves its answer in `text` and `numbers`, which stay valid until
// the next one; a call that throws ends the instance (throw.cpp).
#include <cstdlib>
#include <string>
#include <vector>

#include "reports/live/engine.hpp"

namespace elastocheck::live {
extern std::string name_of_scene;  // throw.cpp

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

[[clang::export_name("open")]] void live_open(const char* scene, std::size_t size, const char* name,
                                              std::size_t name_size) {
    name_of_scene = view(name, name_size);
    text = open(session, view(scene, size), name_of_scene).dump();
}
[[clang::export_name("solve")]] void live_solve(const char* request, std::size_t size) {
    Answer answer = solve(session, request_of(view(request, size)));
    text = answer.head.dump();
    numbers = std::move(answer.numbers);
}
[[clang::export_name("rewrite")]] void live_rewrite(const char* request, std::size_t size) {
    text = rewrite(session, request_of(view(request, size)).settings);
}
[[clang::export_name("text")]] const char* text_at() { return text.data(); }
[[clang::export_name("text_size")]] std::size_t text_size() { return text.size(); }
[[clang::export_name("numbers")]] const double* numbers_at() { return numbers.data(); }
[[clang::export_name("numbers_size")]] std::size_t numbers_size() { return numbers.size(); }
}

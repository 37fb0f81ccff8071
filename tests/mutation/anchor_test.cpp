#include "tests/mutation/anchor.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/mutation/faults.hpp"

namespace elastocheck::mutation {
namespace {

std::vector<std::string> found(const std::string& text, const std::string& name) {
    std::vector<std::string> result;
    for (const Range& range : definitions(text, name))
        result.push_back(text.substr(range.begin, range.end - range.begin));
    return result;
}

using Texts = std::vector<std::string>;

TEST(Anchor, FindsDefinitionsAndNeitherCallsNorDeclarations) {
    EXPECT_EQ(found("double f(int a);\ndouble f(int a) { return a; }\nint k = f(1);\n", "f"),
              Texts{"f(int a) { return a; }"});
    EXPECT_EQ(found("struct A;\nstruct A : B<C> { int x{1}; };\nA a{2};\n", "A"),
              Texts{"A : B<C> { int x{1}; }"});
    EXPECT_EQ(found("void g() { if (f(x)) { h(); } return f(y); }", "f"), Texts{});
    EXPECT_EQ(found("p->size = 1; a.size = 2; size = 3;", "size"), Texts{});
}

TEST(Anchor, FindsEveryOverloadMembersLambdasAndConstants) {
    EXPECT_EQ(found("template <class R>\nM<R> S::f(A a) const noexcept { return {}; }\n"
                    "auto f(B b) -> std::vector<int> { return {b}; }\n",
                    "f")
                  .size(),
              2U);
    EXPECT_EQ(found("S::S(int a) : a{a}, b(1) { c = 2; }", "S").back(),
              "S(int a) : a{a}, b(1) { c = 2; }");
    EXPECT_EQ(found("const auto f = [&](int a) { return a; };\nf(1);", "f"),
              Texts{"f = [&](int a) { return a; };"});
    EXPECT_EQ(found("constexpr double limit = 1e9;  // limit = 2;\n", "limit"),
              Texts{"limit = 1e9;"});
}

TEST(Anchor, IgnoresBracesAndNamesInCommentsAndStrings) {
    EXPECT_EQ(found("// f() {\nint f() { return '}' + g(\"}\") /* } */ + 1'0; }\nint h;", "f"),
              Texts{"f() { return '}' + g(\"}\") /* } */ + 1'0; }"});
}

TEST(Anchor, MatchIgnoresFormattingAndNeedsWholeIdentifiers) {
    const std::string text = "a = b  // the sum\n    + c(d);  ab + c(de);  a = b + c(d)";
    const auto at = occurrences(text, {0, text.size()}, "b + c(d)");
    ASSERT_EQ(at.size(), 2U);
    EXPECT_EQ(text.substr(at[0].begin, at[0].end - at[0].begin), "b  // the sum\n    + c(d)");
    EXPECT_EQ(occurrences(text, {0, text.size()}, "b + c(").size(), 2U);
    EXPECT_EQ(occurrences(text, {0, 10}, "c(d)").size(), 0U);
}

TEST(Faults, MisspeltFaultIsRejectedWithItsLine) {
    const auto faults = parse_faults("# one\nfault a\nsuite p.S\nis b\nin x f\nfind 1 \nmake 2\n");
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].edits[0].definition, "f");
    EXPECT_EQ(faults[0].edits[0].find, "1");
    for (const auto* text :
         {"find 1\n", "fault a\nfault a\n", "fault a\nlook x\n", "fault a\nmake 1\n"})
        EXPECT_THROW(parse_faults(text), std::runtime_error) << text;
}

TEST(Faults, FaultOccursExactlyOnce) {
    const std::string root = testing::TempDir() + "mutation_faults";
    std::filesystem::create_directories(root + "/room");
    const Edit edit{"room", "f", "1 + 2", "1 - 2"};
    const auto problem = [&](const std::string& text) -> std::string {
        write_file(root + "/room/a.cpp", text);
        try {
            return read_file(locate(root, edit).file) == text ? "" : "another file";
        } catch (const std::runtime_error& e) {
            return e.what();
        }
    };
    EXPECT_EQ(problem("int f()\n{ return 1+2; }  // formatted\nint g() { return 1 + 2; }\n"), "");
    EXPECT_EQ(problem("int f() { return (1 + 2) * (1 + 2); }\n"),
              "room: '1 + 2' occurs 2 times in f, not once");
    EXPECT_EQ(problem("int f(); int g() { return 1 + 2; }\n"), "room: no definition of f");
}

}  // namespace
}  // namespace elastocheck::mutation

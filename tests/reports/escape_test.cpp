// Escaping of text for each output language.
#include "reports/text/escape.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace elastocheck::reports {
namespace {

// Control characters, direction changes, bytes that are not UTF-8, and special characters
// of every language.
const std::vector<std::string> odd{
    "a\nb",      "\r",     "\x1b[31m", "\x7F",         "\u0085",
    "\u009b31m", "\u2028", "\u202e",   "\u2066",       std::string("\0", 1),
    "\x85",      "\xA0",   "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
    "\xE2\x80"};

TEST(Escape, UnprintableCharactersInANameAreReported) {
    for (const auto& text : odd) EXPECT_NE(flaw(text), "") << for_terminal(text);
    for (const char* fine : {"", "toe", "Größe", "轮", "\u00a0", "\U0001F697", "<b>&'\"`$(x)"})
        EXPECT_EQ(flaw(fine), "") << fine;
    EXPECT_EQ(flaw("a\x85"), "byte 0x85 is not UTF-8");
    EXPECT_EQ(flaw("a\x1b"), "it has the control character U+001B");
    EXPECT_EQ(flaw("a\u202e"), "it has U+202E, which changes the direction of writing");
}

TEST(Escape, ControlCharactersAreEscapedInEveryFormat) {
    for (const auto& text : odd)
        for (const auto& safe : {for_terminal(text), for_html(text), for_markdown(text),
                                 for_csv(text), for_github(text), for_github_property(text)})
            EXPECT_EQ(flaw(safe), "") << for_terminal(text) << " -> " << for_terminal(safe);
    for (const auto& text : odd) {
        if (text == "a\nb") continue;  // XML has lines
        EXPECT_EQ(flaw(for_xml(text)), "") << for_terminal(text);
    }
}

TEST(Escape, SyntaxOfEachFormatIsEscaped) {
    EXPECT_EQ(for_terminal("a\x1b]0;x\x07\u009b\u202e\x85\n"),
              "a\\x1b]0;x\\x07\\x9b\\x{202e}\\x85\\n");
    EXPECT_EQ(for_html("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&apos;");
    EXPECT_EQ(for_markdown("a|b*_`[x](y)\n# <i>"), "a\\|b\\*\\_\\`\\[x\\](y) \\# \\<i\\>");
    EXPECT_EQ(for_csv("plain"), "plain");
    EXPECT_EQ(for_csv("a,b"), "\"a,b\"");
    EXPECT_EQ(for_csv("a\"\nb"), "\"a\"\" b\"");
    EXPECT_EQ(for_xml("a\nb\x01<"), "a\nb?&lt;");
    EXPECT_EQ(for_github("100 %\n::error::"), "100 %25%0A::error::");
    EXPECT_EQ(for_github_property("a:b,c"), "a%3Ab%2Cc");
    EXPECT_EQ(for_shell("models/a.yaml"), "models/a.yaml");
    EXPECT_EQ(for_shell("it's $(x)"), "'it'\\''s $(x)'");
    EXPECT_EQ(for_shell(""), "''");
}

// Spreadsheets evaluate cells with these beginnings, also in quotes, and take a semicolon for a
// separator where numbers have decimal commas.
TEST(Escape, CsvCellIsNeverAFormula) {
    EXPECT_EQ(for_csv("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
    EXPECT_EQ(for_csv("@SUM(1)"), "'@SUM(1)");
    EXPECT_EQ(for_csv("+cmd"), "'+cmd");
    EXPECT_EQ(for_csv("-cmd"), "'-cmd");
    EXPECT_EQ(for_csv("＝1＋1"), "'＝1＋1");
    EXPECT_EQ(for_csv(" =1"), " '=1");
    EXPECT_EQ(for_csv("\t=1"), " '=1");
    EXPECT_EQ(for_csv("\"=1"), "\"\"\"'=1\"");
    EXPECT_EQ(for_csv("a;=1,@b"), "\"a;'=1,'@b\"");
    for (const char* fine : {"a=b", "-1", "+1.5e-3", "1-2", "toe [deg]", "x@y"})
        EXPECT_EQ(for_csv(fine), fine);
}

TEST(Escape, NameInMarkdownMakesNoListLinkOrFormula) {
    EXPECT_EQ(for_markdown("- x"), "\\- x");
    EXPECT_EQ(for_markdown("+ x"), "\\+ x");
    EXPECT_EQ(for_markdown("---"), "\\---");
    EXPECT_EQ(for_markdown("12. x"), "12\\. x");
    EXPECT_EQ(for_markdown("1) x"), "1\\) x");
    EXPECT_EQ(for_markdown("https://x www.y"), "https\\://x www\\.y");
    EXPECT_EQ(for_markdown("$x$"), "\\$x\\$");
    for (const char* fine : {"-0.3", "1.5", "-", "a: b", "12", "a - b"})
        EXPECT_EQ(for_markdown(fine), fine);
}

}  // namespace
}  // namespace elastocheck::reports

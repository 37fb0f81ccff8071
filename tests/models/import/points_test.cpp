// Lists of named points, as kinematics programs and spreadsheets export them.
#include <gtest/gtest.h>

#include <minizip/zip.h>

#include "models/import/import.hpp"
#include "models/reader/tables/sheet.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using namespace tests;

importer::Options with_axes(const std::string& axes) {
    importer::Options options;
    options.axes = axes;
    return options;
}

TEST(Points, UnreadablePointsAreRefusedWithTheirLine) {
    importer::Options options = with_axes("x-forward,y-left");
    expect_refusals("points", "name,x_mm,y_mm,z_mm\na,1,2,3\n", "p.csv",
                    [&](const std::string& text) { return refusal_of(text, "p.csv", options); });
    options.unit = "ft";
    EXPECT_TRUE(has_text(refusal_of("name,x,y,z\na,2,4,8\n", "p.csv", options),
                         "'ft' is not a unit of a coordinate"));
}

// A workbook of one sheet, or two, by its parts.
using Parts = std::vector<std::pair<std::string, std::string>>;

std::string workbook(const support::Folder& place, const Parts& parts) {
    const std::string file = (place.path / "p.xlsx").string();
    const zipFile zip = zipOpen(file.c_str(), APPEND_STATUS_CREATE);
    for (const auto& [name, text] : parts) {
        zipOpenNewFileInZip(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                            Z_DEFAULT_COMPRESSION);
        zipWriteInFileInZip(zip, text.data(), static_cast<unsigned>(text.size()));
        zipCloseFileInZip(zip);
    }
    zipClose(zip, nullptr);
    return file;
}

// As spreadsheets save it: shared strings, formatted in parts, numbers of 17 digits, rows and cells left out.
const Parts saved_book{
    {"xl/workbook.xml",
     R"(<workbook xmlns:r="r"><sheets><sheet name="Notes" state="visible" r:id="a"/><sheet name="Old" state="hidden" r:id="b"/>)"
     R"(<sheet name="Front &amp; more" r:id="c"/></sheets></workbook>)"},
    {"xl/_rels/workbook.xml.rels",
     R"(<Relationships><Relationship Id="a" Target="worksheets/sheet1.xml"/><Relationship Id="b" )"
     R"(Target="worksheets/sheet3.xml"/><Relationship Id="c" Target="/xl/worksheets/sheet2.xml"/></Relationships>)"},
    {"xl/sharedStrings.xml",
     "<sst><si><t>Name</t></si><si><r><t>X </t></r><r><t>[mm]</t></r></si><si><t>Y [mm]</t></si>"
     "<si><t>Z [mm]</t><rPh><t>no</t></rPh></si><si><t>Lower, \"ball\"</t></si></sst>"},
    {"xl/worksheets/sheet1.xml",
     R"(<worksheet><sheetData><row r="1"><c r="A1"><v>1</v></c></row></sheetData></worksheet>)"},
    {"xl/worksheets/sheet2.xml",
     R"(<x:worksheet><x:sheetData><x:row r="3"><x:c r="B3" t="s"><x:v>0</x:v></x:c><x:c r="C3" t="s">)"
     R"(<x:v>1</x:v></x:c><x:c t="s"><x:v>2</x:v></x:c><x:c t="s"><x:v>3</x:v></x:c></x:row>)"
     R"(<x:row r="5"><x:c r="B5" t="s"><x:v>4</x:v></x:c><x:c r="C5"><x:f>1+1</x:f><x:v>12.5</x:v></x:c>)"
     R"(<x:c r="D5"><x:v>5.6250000000000001E2</x:v></x:c><x:c r="E5"><x:v>-62.5</x:v></x:c></x:row>)"
     R"(<x:row r="6"><x:c r="B6" t="inlineStr"><x:is><x:t>Rack</x:t></x:is></x:c><x:c r="C6"><x:v>1</x:v></x:c>)"
     R"(<x:c r="D6"><x:v>2</x:v></x:c><x:c r="E6"><x:v>3</x:v></x:c></x:row></x:sheetData></x:worksheet>)"}};

TEST(PointsTable, WorkbookIsReadAsTheTableOfItsSheet) {
    const support::Folder place;
    const auto read = [&](const Parts& parts, const std::string& sheet = "") {
        importer::Options options = with_axes("x-forward,y-left");
        options.sheet = sheet;
        return importer::import_file(workbook(place, parts), options).yaml;
    };
    const auto refused = [&](const Parts& parts, const std::string& sheet = "") {
        return refusal_of([&] { (void)read(parts, sheet); });
    };
    const auto with = [](std::size_t part, const std::string& what, const std::string& by) {
        Parts parts = saved_book;
        parts[part].second = replaced(parts[part].second, what, by);
        return parts;
    };
    const std::string yaml = read(saved_book);
    EXPECT_TRUE(has_text(yaml, "Lower___ball_: [12.5, 562.5, -62.5]"));
    EXPECT_TRUE(has_text(yaml, "Rack: [1, 2, 3]  # line 6, Rack"));
    EXPECT_EQ(read(saved_book, "Front & more"), yaml);
    EXPECT_TRUE(has_text(
        refused(with(4, "<x:v>3</x:v></x:c></x:row></x:s", "<x:v>#REF!</x:v></x:c></x:row></x:s")),
        "p.xlsx:6: Rack: z is not a number: '#REF!' in column E"));
    EXPECT_TRUE(has_text(refused(saved_book, "Frnt & more"), "did you mean 'Front & more'?"));
    EXPECT_TRUE(has_text(refused(saved_book, "Old"), "--sheet: there is no sheet 'Old'"));
    EXPECT_TRUE(has_text(refused(saved_book, "Notes"), "no column name"));
    const Parts two = with(1, "sheet1.xml", "sheet2.xml");
    EXPECT_TRUE(
        has_text(refused(two), "several sheets have numbers; choose one: Notes, Front & more"));
    EXPECT_EQ(read(two, "Front & more"), yaml);
    EXPECT_TRUE(has_text(refused(with(4, "row r=\"6\"", "row r=\"4\"")),
                         "p.xlsx:4: Front & more: rows are not"));
    EXPECT_TRUE(has_text(refused(with(4, "r=\"D5\"", "r=\"B5\"")),
                         "p.xlsx:5: Front & more: cells are not"));
    EXPECT_TRUE(has_text(refused(with(4, "</x:worksheet>", "")), "sheet2.xml' of the workbook: "));
    EXPECT_TRUE(has_text(refused({saved_book[1]}), "a workbook without a visible sheet"));
    Parts large = saved_book;
    large[2].second.assign(65 << 20, ' ');  // packs to a thousandth
    EXPECT_TRUE(has_text(refused(large), "is larger than 64 MiB"));
    const std::string whole = support::text_of(workbook(place, saved_book));
    std::string damaged = whole;
    damaged[60] = static_cast<char>(damaged[60] ^ 0x55);
    const std::string file = place.write("d.xlsx", damaged);
    EXPECT_FALSE(
        refusal_of([&] { importer::import_file(file, with_axes("x-forward,y-left")); }).empty());
}

// The parts of the markers are displaced and rotated; a point whose place is an expression is left out.
TEST(Points, AdamsViewCoordinatesAreReadRelativeToTheMarkerOrPartOfTheirCommand) {
    const std::string text = support::text_of(import_folder / "points/view.cmd");
    importer::Options options = with_axes("x-rearward,y-left,z-up");
    const auto read = importer::import_text(text, "c.cmd", options);
    EXPECT_TRUE(has_text(read.yaml, "hpl_uca_front: [100, 240, 280.8]  # line 12, hpl_uca_front"));
    EXPECT_TRUE(has_text(read.yaml, "upper_ball: [-12, 540, 300]"));
    EXPECT_TRUE(has_text(read.yaml, "lower_ball: [5, 575, 110]"));
    EXPECT_TRUE(has_text(notes_of(read), "with a place that is an expression: line 41, "));
    options.as = "double_wishbone";
    EXPECT_EQ(importer::import_text(text, "c.cmd", options).bodies, 4);
    const std::string listed = support::text_of(import_folder / "points/listed.cmd");
    const auto other = importer::import_text(listed, "c.cmd", with_axes("x-forward,y-left"));
    EXPECT_TRUE(has_text(other.yaml, "arm_outer: [500, 250, 100]"));
    EXPECT_TRUE(has_text(other.yaml, "arm_inner: [750, 500, 100]"));
    const auto refused = [&](const std::string& what, const std::string& by) {
        return refusal_of(replaced(listed, what, by), "c.cmd", with_axes("x-forward,y-left"));
    };
    EXPECT_TRUE(has_text(refused("= .car.ground.turned\n", "= .car.arm\n"),
                         "c.cmd:5: relative_to: no command before creates '.car.arm'"));
    EXPECT_TRUE(has_text(refused("length = meter", "length = mile"), "c.cmd:2: length: 'mile'"));
    EXPECT_TRUE(has_text(refused("length = meter", ""), "--unit: the file does not say its unit"));
}

TEST(PointsTable, CellsAreSplitAtTheSeparatorThatTheFileDeclaresOrUses) {
    const auto rows = [](const char* text) { return reader::read_sheet(text, "p.csv", 4); };
    const auto sheet = rows("sep=|\r\n\r\n a |\"b\"\"|c\"|d|1,5;2\r\n");
    ASSERT_EQ(sheet.rows.size(), 1u);
    EXPECT_EQ(sheet.rows[0].line, 3);
    EXPECT_EQ(sheet.rows[0].cells, (std::vector<std::string>{"a", "b\"|c", "d", "1,5;2"}));
    EXPECT_EQ(rows("a;1,5;2,5;3,5\n").separator, ';');
    EXPECT_EQ(rows("a,1.5,2.5,\"3;5;;\"\n").separator, ',');
    EXPECT_EQ(rows("a\t1,5\t2,5\t3,5\n").separator, '\t');
    EXPECT_EQ(reader::letters_of(0) + reader::letters_of(25) + reader::letters_of(26) +
                  reader::letters_of(701) + reader::letters_of(702),
              "AZAAZZAAA");
}

}  // namespace
}  // namespace elastocheck

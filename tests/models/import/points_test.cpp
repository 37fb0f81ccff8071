// Lists of named points, as kinematics programs and spreadsheets export them.
#include <gtest/gtest.h>

#include <minizip/zip.h>

#include <algorithm>

#include "elastocheck/scene.hpp"
#include "models/import/import.hpp"
#include "models/import/property/spreadsheet.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using namespace tests;

importer::Options with_axes(const std::string& axes) {
    importer::Options options;
    options.axes = axes;
    return options;
}

TEST(Points, AreTurnedToTheAxesOfAScene) {
    const std::string table =
        "Point Name,X [m],Y [m],Z [m],remark\nlower ball,-0.0125,0.5625,-0.0625,a\n"
        "tie rod inner,+0.075,0.25,0.125,b\n";
    for (const auto& [axes, part] :
         {std::pair{"x-rearward,y-left,z-down", "tie_rod_inner: [-75, 250, -125]"},
          {"x-rearward,y-left,z-up", "tie_rod_inner: [-75, 250, 125]"},
          {"x-rearward,y-right", "lower_ball: [12.5, -562.5, -62.5]"}}) {
        const std::string yaml = importer::import_text(table, "p.csv", with_axes(axes)).yaml;
        EXPECT_TRUE(says(yaml, part));
        EXPECT_TRUE(says(yaml, axes));
        EXPECT_TRUE(says(yaml, "# Understood: 2 points."));
        EXPECT_EQ(yaml.find("left-handed") != yaml.npos, std::string_view(axes).ends_with("z-up"));
    }
}

TEST(Points, ThatCannotBeReadAreRefusedWithTheirLine) {
    const auto refused = [](const std::string& text, const std::string& file = "p.csv",
                            const std::string& axes = "x-forward,y-left") {
        return refusal_of(text, file, with_axes(axes));
    };
    const std::string good = "name,x_mm,y_mm,z_mm\na,1,2,3\n";
    EXPECT_TRUE(says(refused(good, "p.csv", ""), "--axes: a table of points"));
    EXPECT_TRUE(says(refused(good, "p.csv", "x-up"), "is not a set of axes"));
    support::expect_refusals(import_folder / "mistakes/points.mistakes", good, "p.csv",
                             [&](const std::string& text) {
                                 const std::string said = refused(text);
                                 return said.empty() ? "accepted" : said;
                             });
    // z of a frame that may be left-handed is not guessed
    for (const char* axes : {"x-rearward,y-left", "x-forward,y-right"})
        EXPECT_TRUE(says(refused(good, "p.csv", axes), "needs its z"));
    EXPECT_TRUE(says(refused("LOWER WISHBONE 1 2 3\n", "p.shk"), "no point in this file"));
}

// A front wheel behind the rear one, a left one to the right: the axes are wrong.
TEST(Points, WhoseNamesContradictTheAxesAreRefused) {
    const std::string table =
        "Point Name,X (mm),Y (mm),Z (mm)\nWheel Center LF,774.7,584.2,223.5\n"
        "Wheel Center RF,774.7,-584.2,223.5\nWheel Center LR,-774.7,571.5,223.5\n";
    for (const auto& [axes, said] :
         {std::pair{"x-rearward,y-left,z-up",
                    "p.csv:2: Wheel Center LF: lies behind Wheel Center LR (line 4)"},
          {"x-forward,y-right,z-up",
           "p.csv:2: Wheel Center LF: lies to the right of Wheel Center RF (line 3)"}})
        EXPECT_TRUE(says(refusal_of(table, "p.csv", with_axes(axes)), said));
    EXPECT_NO_THROW((void)importer::import_text(table, "p.csv", with_axes("x-forward,y-left")));
}

std::string file_of_points(const std::string& name) {
    return support::text_of(import_folder / "points" / name);
}

importer::Options with_columns(const std::string& columns, const std::string& unit = "") {
    return {.axes = "x-forward,y-left", .columns = columns, .unit = unit};
}

std::string refused_table(const std::string& text, const std::string& columns,
                          const std::string& unit = "") {
    return refusal_of(text, "p.csv", with_columns(columns, unit));
}

// A byte-order mark, semicolons, decimal commas, quotes with line ends and semicolons in them, titles
// above and between, a line of units, further columns.
TEST(PointsTable, OfASpreadsheetIsReadWithAMapOfItsColumns) {
    const std::string text = file_of_points("spreadsheet.csv");
    std::string first;
    // by headings in any case, numbers, letters
    for (const char* columns :
         {"name=Punkt,x=X-Wert fahrzeugfest,y=y-wert,z=Z-Wert", "name=2,x=3,y=4,z=5",
          "name=B,x=c,y=D,z=E", "z=Z-Wert,y=4,x=C,name=Punkt"}) {
        const std::string yaml =
            importer::import_text(text, "points.csv", with_columns(columns)).yaml;
        for (const char* part : {"Lenker_unten__vorn: [-12.5, 562.5, -62.5]",
                                 "Spurstange_innen: [75, 250, -125.25]", "_oben: [40, 480, 310]",
                                 "in mm, by the heading '[mm]' in line 5, with decimal commas",
                                 "line without coordinates: line 8"})
            EXPECT_TRUE(says(yaml, part)) << columns;
        if (first.empty()) first = yaml;
        EXPECT_EQ(yaml, first) << columns;
    }
}

// The refusal of unknown headings lists them, and the option that it shows reads the file.
TEST(PointsTable, WithUnknownHeadingsIsRefusedWithTheOptionToType) {
    const std::string text = file_of_points("spreadsheet.csv"), said = refused_table(text, "");
    EXPECT_TRUE(says(said,
                     "p.csv:3: no column name, x, y, z; headings: 'Nr' (A), 'Punkt' (B), "
                     "'X-Wert fahrzeugfest' (C), "));
    const std::string option = "--columns ";
    const auto at = said.find(option);
    ASSERT_NE(at, said.npos);
    std::string columns = said.substr(at + option.size());
    columns.resize(columns.find(' '));
    EXPECT_EQ(columns, "name=Punkt,x=C,y=Y-Wert,z=Z-Wert");
    EXPECT_EQ(refused_table(text, columns), "");
}

// The one column of words without a heading has the names; of two none is chosen.
TEST(PointsTable, HasItsNamesInTheColumnWithoutAHeading) {
    const std::string unnamed = "X,Y,Z,\n(mm),(mm),(mm),\n110,215,150,LBJ\n160,600,248,WC\n";
    EXPECT_TRUE(says(importer::import_text(unnamed, "p.csv", with_columns("")).yaml,
                     "LBJ: [110, 215, 150]"));
    const std::string two = "X,Y,Z,,\n(mm),(mm),(mm),,\n110,215,150,LBJ,a\n160,600,248,WC,b\n";
    EXPECT_TRUE(
        says(refused_table(two, ""), "none (D), none (E); choose with --columns name=D,x=X,"));
    EXPECT_EQ(refused_table(two, "name=D,x=X,y=Y,z=Z"), "");
}

// Headings in two rows: the upper one says the side, or the wheel.
TEST(PointsTable, HasSeveralGroupsOfColumnsUnderTheirHeadings) {
    const auto table = [](const char* first, const char* second) {
        return fmt::format(
            ",{},,,{},,\nPoint,X [mm],Y [mm],Z [mm],X [mm],Y [mm],Z [mm]\nLBJ,1,2,3,4,-5,6\n",
            first, second);
    };
    for (const auto& [first, second, one, other] :
         {std::tuple{"Left", "RIGHT SIDE", "left_LBJ: [1, 2, 3]", "right_LBJ: [4, -5, 6]"},
          {"Front left", "front right", "LF_LBJ: [1, 2, 3]", "RF_LBJ: [4, -5, 6]"},
          {"Stand 1", "Stand 2", "Stand_1_LBJ: [1, 2, 3]", "Stand_2_LBJ: [4, -5, 6]"}}) {
        const std::string yaml =
            importer::import_text(table(first, second), "p.csv", with_columns("")).yaml;
        EXPECT_TRUE(says(yaml, one) && says(yaml, other));
    }
    for (const char* second : {"", "Left"})
        EXPECT_TRUE(says(refused_table(table("Left", second), ""), "two columns of x"));
}

TEST(PointsTable, SaysWhatIsWrongInAMap) {
    const std::string text = file_of_points("spreadsheet.csv");
    for (const auto& [columns, said] : std::vector<std::pair<const char*, const char*>>{
             {"name=Pnkt,x=C,y=D,z=E",
              "p.csv:3: --columns: name: 'Pnkt' is neither a heading nor a "
              "number or letter of the 7 columns, did you mean 'Punkt'?"},
             {"name=Punkt,x=C,y=D,z=Z", "z: 'Z' is neither a heading"},
             {"name=Punkt,x=C,y=D,z=0", "z: '0' is neither a heading"},
             {"name=Punkt,x=C,y=D,z=8", "z: '8' is neither a heading"},
             {"name=Punkt,x=C,y=D", "--columns: no z in "},
             {"name=Punkt,x=C,y=D,z=E,nmae=A",
              "'nmae' is nothing that a point has, did you mean "
              "'name'?"},
             {"name=Punkt,x=C,y=C,z=E", "x and y are the same column C"},
             {"name=Punkt,x=C,y=D,z=E,x=F", "x is given twice"},
             {"name=Punkt,x=C,y=D,z=", "no column for z"},
             {"Punkt,x=C,y=D,z=E", "'Punkt' has no '='"},
             {"name=Punkt,left.x=C,left.y=D,left.z=E", "no right.x in "},
             {"name=B,left.x=C,x=D", "instead of x, y, z and side"}})
        EXPECT_TRUE(says(refused_table(text, columns), said)) << columns;
    // the cells of points are no headings, even where they are like a letter
    EXPECT_TRUE(says(importer::import_text("A,1,2,3\nb,4,5,6\n", "p.csv",
                                           with_columns("name=A,x=B,y=C,z=D", "mm"))
                         .yaml,
                     "A: [1, 2, 3]"));
    EXPECT_TRUE(says(refused_table("n,x,x,y,z\na,1,2,3,4\n", "name=n,x=x,y=y,z=z", "m"),
                     "x: columns B and C have the heading 'x'"));
}

// The unit comes from all headings, from the lines below them, or from the option, never from nothing.
TEST(PointsTable, HasTheUnitThatIsSaid) {
    const auto x_of = [](const std::string& head, const std::string& unit) -> std::string {
        const std::string text = head + "\na,2,4,8\n";
        const std::string said = refused_table(text, "", unit);
        if (!said.empty()) return said;
        const std::string yaml = importer::import_text(text, "p.csv", with_columns("", unit)).yaml;
        const auto at = yaml.find("a: [");
        return yaml.substr(at + 4, yaml.find(']') - at - 4);
    };
    const char *mm = "2, 4, 8", *cm = "20, 40, 80", *m = "2000, 4000, 8000",
               *in = "50.8, 101.6, 203.2";
    for (const auto& [head, unit, expected] :
         std::vector<std::tuple<const char*, const char*, const char*>>{
             {"name,x [mm],y [mm],z [mm]", "", mm},
             {"name,x_cm,y_cm,z_cm", "", cm},
             {"name,X/m,Y/m,Z/m", "", m},
             {"name,x (inch),y (inch),z (inch)", "", in},
             {"name,x,y,z\n,in,in,in", "", in},
             {"name,x,y,z\n,[m],[m],[m]", "m", m},
             {"name,x,y,z", "cm", cm},
             {"name,x [mm],y [mm],z [mm]", "mm", mm},
             {"name,x,y,z", "",
              "p.csv:1: x: no unit in its heading or below it; say it with "
              "--unit: mm, cm, m, in"},
             {"name,x [mm],y [mm],z", "", "p.csv:1: z: no unit"},
             {"name,x [mm],y [mm],z [m]", "", "different units, mm and m"},
             {"name,x [mm],y [mm],z [mm]", "m",
              "in mm by the heading 'x [mm]' in line 1; --unit "
              "says m"},
             {"name,x,y,z", "ft", "'ft' is not a unit of a coordinate"}})
        EXPECT_TRUE(says(x_of(head, unit), expected)) << head << " " << unit;
}

// Both sides in one table: two triples of columns, or a column that says the side.
TEST(PointsTable, HasBothSidesByColumnsOrByAColumn) {
    const std::string pair =
        importer::import_text(file_of_points("sides.csv"), "p.csv",
                              with_columns("name=hardpoint,left.x=xl [m],left.y=yl [m],left.z=zl "
                                           "[m],right.x=E,right.y=F,right.z=G"))
            .yaml;
    for (const char* part :
         {"left_lower_ball: [500, 750, 250]", "right_lower_ball: [500, -750, 250]",
          "left_tie_rod_outer: [375, 500, 250]", "right_tie_rod_outer: [375, -437.5, 250]"})
        EXPECT_TRUE(says(pair, part));
    const std::string columns = "name=point,side=Seite,x=X,y=Y,z=Z";
    const std::string rows = file_of_points("side_column.csv");  // with tabs
    const std::string yaml = importer::import_text(rows, "p.csv", with_columns(columns, "m")).yaml;
    for (const char* part : {" left_lower_ball: [500, 750, 250]",
                             " right_lower_ball: [500, -750, 250]", " rack: [250, 0, 125]"})
        EXPECT_TRUE(says(yaml, part));
    EXPECT_TRUE(says(refused_table("point,Seite,X,Y,Z\na,oben,1,2,3\n", columns, "m"),
                     "p.csv:2: side: 'oben' is not a side"));
    // without the column the second point of a name gets a number, with a warning
    const auto twice = importer::import_text(rows, "p.csv", with_columns("", "m"));
    ASSERT_EQ(twice.notes.warnings.size(), 1u);
    EXPECT_TRUE(says(twice.notes.warnings[0].second, "in line 2 too"));
    // y as distance from the middle
    const auto alike = importer::import_text("point,Seite,X,Y,Z\na,l,1,2,3\na,r,1,2,3\n", "p.csv",
                                             with_columns(columns, "m"));
    ASSERT_EQ(alike.notes.warnings.size(), 1u);
    EXPECT_TRUE(says(alike.notes.warnings[0].second,
                     "1 of 1 pairs of points left and right are on the same side"));
}

TEST(PointsTable, HasColumnsThatOtherFilesDoNotHave) {
    importer::Options mapped = with_axes("x-forward,y-left");
    mapped.columns = "name=A,x=B,y=C,z=D";
    EXPECT_TRUE(says(refusal_of("x", "p.sub", mapped), "--columns: only for tables of points"));
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

TEST(PointsTable, OfAWorkbookIsReadAsThatOfItsSheet) {
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
    EXPECT_TRUE(says(yaml, "Lower___ball_: [12.5, 562.5, -62.5]"));
    EXPECT_TRUE(says(yaml, "Rack: [1, 2, 3]  # line 6, Rack"));
    EXPECT_EQ(read(saved_book, "Front & more"), yaml);
    EXPECT_TRUE(says(
        refused(with(4, "<x:v>3</x:v></x:c></x:row></x:s", "<x:v>#REF!</x:v></x:c></x:row></x:s")),
        "p.xlsx:6: Rack: z is not a number: '#REF!' in column E"));
    EXPECT_TRUE(says(refused(saved_book, "Frnt & more"), "did you mean 'Front & more'?"));
    EXPECT_TRUE(says(refused(saved_book, "Old"), "--sheet: there is no sheet 'Old'"));
    EXPECT_TRUE(says(refused(saved_book, "Notes"), "no column name"));
    const Parts two = with(1, "sheet1.xml", "sheet2.xml");
    EXPECT_TRUE(says(refused(two), "several sheets have numbers; choose one: Notes, Front & more"));
    EXPECT_EQ(read(two, "Front & more"), yaml);
    EXPECT_TRUE(says(refused(with(4, "row r=\"6\"", "row r=\"4\"")),
                     "p.xlsx:4: Front & more: rows are not"));
    EXPECT_TRUE(
        says(refused(with(4, "r=\"D5\"", "r=\"B5\"")), "p.xlsx:5: Front & more: cells are not"));
    EXPECT_TRUE(says(refused(with(4, "</x:worksheet>", "")), "sheet2.xml' of the workbook: "));
    EXPECT_TRUE(says(refused({saved_book[1]}), "a workbook without a visible sheet"));
    Parts large = saved_book;
    large[2].second.assign(65 << 20, ' ');  // packs to a thousandth
    EXPECT_TRUE(says(refused(large), "is larger than 64 MiB"));
    const std::string whole = support::text_of(workbook(place, saved_book));
    std::string damaged = whole;
    damaged[60] = static_cast<char>(damaged[60] ^ 0x55);
    const std::string file = place.write("d.xlsx", damaged);
    EXPECT_FALSE(
        refusal_of([&] { importer::import_file(file, with_axes("x-forward,y-left")); }).empty());
}

// Points and markers of parts that are placed and turned; a place that is an expression is left out.
TEST(Points, OfAdamsViewAreInTheFramesOfTheirCommands) {
    const std::string text = file_of_points("view.cmd");
    importer::Options options = with_axes("x-rearward,y-left,z-up");
    const auto read = importer::import_text(text, "c.cmd", options);
    EXPECT_TRUE(says(read.yaml, "hpl_uca_front: [100, 240, 280.8]  # line 12, hpl_uca_front"));
    EXPECT_TRUE(says(read.yaml, "upper_ball: [-12, 540, 300]"));
    EXPECT_TRUE(says(read.yaml, "lower_ball: [5, 575, 110]"));
    EXPECT_TRUE(says(notes_of(read), "with a place that is an expression: line 41, "));
    options.as = "double_wishbone";
    EXPECT_EQ(importer::import_text(text, "c.cmd", options).bodies, 4);
    const std::string listed = file_of_points("listed.cmd");
    const auto other = importer::import_text(listed, "c.cmd", with_axes("x-forward,y-left"));
    EXPECT_TRUE(says(other.yaml, "arm_outer: [500, 250, 100]"));
    EXPECT_TRUE(says(other.yaml, "arm_inner: [750, 500, 100]"));
    const auto refused = [&](const std::string& what, const std::string& by) {
        return refusal_of(replaced(listed, what, by), "c.cmd", with_axes("x-forward,y-left"));
    };
    EXPECT_TRUE(says(refused("= .car.ground.turned\n", "= .car.arm\n"),
                     "c.cmd:5: relative_to: no command before creates '.car.arm'"));
    EXPECT_TRUE(says(refused("length = meter", "length = mile"), "c.cmd:2: length: 'mile'"));
    EXPECT_TRUE(says(refused("length = meter", ""), "--unit: the file does not say its unit"));
}

TEST(PointsTable, SplitsAsItsSeparatorSays) {
    const auto rows = [](const char* text) { return importer::read_sheet(text, "p.csv", 4); };
    const auto sheet = rows("sep=|\r\n\r\n a |\"b\"\"|c\"|d|1,5;2\r\n");
    ASSERT_EQ(sheet.rows.size(), 1u);
    EXPECT_EQ(sheet.rows[0].line, 3);
    EXPECT_EQ(sheet.rows[0].cells, (std::vector<std::string>{"a", "b\"|c", "d", "1,5;2"}));
    EXPECT_EQ(rows("a;1,5;2,5;3,5\n").separator, ';');
    EXPECT_EQ(rows("a,1.5,2.5,\"3;5;;\"\n").separator, ',');
    EXPECT_EQ(rows("a\t1,5\t2,5\t3,5\n").separator, '\t');
    EXPECT_EQ(importer::letters_of(0) + importer::letters_of(25) + importer::letters_of(26) +
                  importer::letters_of(701) + importer::letters_of(702),
              "AZAAZZAAA");
}

}  // namespace
}  // namespace elastocheck

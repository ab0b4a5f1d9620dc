#include "solver/continuous/figure_drawing.h"

#include "solver/continuous/expressions.h"
#include "solver/continuous/figure_palette.h"
#include "solver/continuous/figure_view.h"
#include "solver/continuous/reading.h"
#include "solver/core/svg_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

constexpr double kLine = 15;     // from line to line of text
constexpr double kLetter = 6.6;  // how wide a letter is, generously
constexpr double kMargin = 12;
constexpr double kSwatch = 9;
constexpr std::size_t kNameBytesMax = 40;
constexpr std::size_t kCaptionLinesMax = 10;

constexpr const char* kStyle =
    "<style>\n"
    ".figures { color: #222; background: #fff; font: 12px system-ui, sans-serif; }\n"
    ".figures text { fill: currentColor; }\n"
    ".figures .title { font-size: 15px; font-weight: 600; }\n"
    ".figures .rank { font-size: 13px; font-weight: 600; }\n"
    ".figures path { stroke-linejoin: round; stroke-linecap: round; }\n"
    ".figures .face { stroke-width: 0.4; }\n"
    ".figures .edge { fill: none; stroke: #222; stroke-width: 1.2; }\n"
    ".figures .hidden { fill: none; stroke: currentColor; stroke-width: 0.9; "
    "stroke-dasharray: 1.5 2.8; stroke-opacity: 0.55; }\n"
    ".figures .cube { fill: none; stroke: currentColor; stroke-width: 0.7; stroke-opacity: 0.3; }\n"
    ".figures .axis { fill: none; stroke: currentColor; }\n"
    ".figures .point { fill: #fff; stroke: #222; }\n"
    ".figures .hidden-point { fill: none; stroke: currentColor; stroke-opacity: 0.55; }\n"
    "@media (prefers-color-scheme: dark) {\n"
    ".figures { color: #e8e8e8; background: #161616; }\n"
    "}\n"
    "</style>\n";

constexpr std::array<const char*, 4> kRankNames = {"inside", "face", "edge", "corner"};
constexpr std::array<const char*, 4> kRankHeadings = {"Insides", "Faces", "Edges", "Corners"};

std::string text_at(double x, double y, const std::string& text, const char* attributes = "") {
    return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\"" + attributes + ">" +
           svg_escaped(text) + "</text>\n";
}

// Letters of UTF-8.
std::size_t letter_count(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

// A text in lines of at most so many letters, cut at spaces; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t letters_max) {
    std::vector<std::string> lines(1);
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        std::string& line = lines.back();
        if (line.empty()) {
            line = word;
        } else if (letter_count(line) + 1 + letter_count(word) <= letters_max) {
            line += " " + word;
        } else {
            lines.push_back(word);
        }
        at = end + 1;
    }
    if (lines.size() > kCaptionLinesMax) {
        lines.resize(kCaptionLinesMax);
        lines.back() += " …";
    }
    return lines;
}

// Two digits after the point at most.
std::string decimal(double value) {
    const auto hundredths = std::lround(value * 100);
    const auto size = std::labs(hundredths);
    std::string text = (hundredths < 0 ? "-" : "") + std::to_string(size / 100);
    if (size % 100 != 0) {
        text += size % 10 == 0 ? "." + std::to_string(size / 10 % 10)
                               : "." + std::to_string(size % 100 + 100).substr(1);
    }
    return text;
}

// A part of the drawing: what it is, and how much of the height it takes.
struct Part {
    std::string svg;
    double height = 0;
};

class Drawing {
  public:
    explicit Drawing(const ExampleReading& reading)
        : reading_(reading),
          figures_(reading.figures()),
          palette_(reading.example()),
          writer_(reading.topes()) {}

    [[nodiscard]] int rank(std::size_t number) const {
        return rank_of(reading_.topes(), figures_.relevant(static_cast<Label>(number)));
    }

    // Around 0, 0; the cube's half-edges have this length.
    [[nodiscard]] std::string picture(std::size_t number, ViewFrom from, double length) {
        const auto label = static_cast<Label>(number);
        const FigureView view =
            view_figure(reading_.topes(), figures_.at(label), figures_.relevant(label), from);
        std::string svg = used("behind", from);
        for (const FigurePiece& piece : view.surfaces) {
            svg += painted(
                palette_.surface(piece.object, piece.normal), outline(piece.outline, length)
            );
            svg += path("edge", piece.edges, length);
        }
        std::map<std::string, std::string> cuts;  // outlines by paint: none of them hides another
        std::vector<Stroke> cut_edges;
        for (const FigurePiece& piece : view.cuts) {
            cuts[palette_.cut(piece.object, piece.normal)] += outline(piece.outline, length);
            cut_edges.insert(cut_edges.end(), piece.edges.begin(), piece.edges.end());
        }
        for (const auto& [paint, outlines] : cuts) {
            svg += painted(paint, outlines);
        }
        svg += path("edge", cut_edges, length) + used("rest", from);
        svg += path("hidden", view.edges, length);
        return svg + "<circle class=\"" + (view.is_point_hidden ? "hidden-point" : "point") +
               "\" r=\"2.2\"/>\n";
    }

    // Each object with where it stands, below y = 0.
    [[nodiscard]] Part caption(std::size_t number, double width, bool with_names) {
        Part part;
        const auto letters = static_cast<std::size_t>((width - 2 * kSwatch) / kLetter);
        const auto lines_of = texts(number, with_names);
        if (lines_of.empty()) {
            return {text_at(0, kLine - 3, "empty space"), kLine};
        }
        for (const auto& [object, text] : lines_of) {
            part.svg += swatch(0, part.height, object);
            for (const std::string& line : wrapped(text, letters)) {
                part.height += kLine;
                part.svg += text_at(kSwatch + 5, part.height - 3, line);
            }
        }
        return part;
    }

    // "3 corner; wall: h1 ∧ h2; grass: ¬h1".
    [[nodiscard]] std::string description(std::size_t number) {
        std::string text =
            std::to_string(number) + " " + kRankNames[static_cast<std::size_t>(rank(number))];
        for (const auto& [object, expression] : texts(number, true)) {
            text += "; " + expression;
        }
        return text;
    }

    // What the half-spaces of some families are, in columns.
    [[nodiscard]] Part half_spaces(FamilySet families, double width) const {
        constexpr double kColumn = 185;
        Part part = {text_at(0, kLine - 3, "h is the half-space where n · p < 0:"), 0};
        const auto columns = static_cast<std::size_t>(std::max(1.0, width / kColumn));
        std::size_t shown = 0;
        for (std::size_t family = 0; family < reading_.topes().family_count(); ++family) {
            if ((families >> family & 1) == 0) {
                continue;
            }
            const Point& n = reading_.topes().normals()[family];
            part.svg += text_at(
                kColumn * static_cast<double>(shown % columns),
                kLine * static_cast<double>(shown / columns + 2) - 3,
                "h" + std::to_string(family + 1) + ": n = (" + decimal(n.x()) + ", " +
                    decimal(n.y()) + ", " + decimal(n.z()) + ")"
            );
            ++shown;
        }
        part.height = kLine * static_cast<double>((shown + columns - 1) / columns + 1);
        return part;
    }

    // The objects by colour, in columns.
    [[nodiscard]] Part objects(double width) const {
        constexpr double kColumn = 185;
        constexpr std::size_t kColumnBytes = 20;
        Part part;
        const auto columns = static_cast<std::size_t>(std::max(1.0, width / kColumn));
        const auto& all = reading_.example().objects;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double x = kColumn * static_cast<double>(i % columns);
            const double y = kLine * static_cast<double>(i / columns);
            part.svg += swatch(x, y, static_cast<ObjectId>(i + 1));
            part.svg +=
                text_at(x + kSwatch + 5, y + kLine - 3, shortened(all[i].name, kColumnBytes));
        }
        part.height = kLine * static_cast<double>((all.size() + columns - 1) / columns);
        return part;
    }

    // Where x, y and z point to, around 0, 0.
    [[nodiscard]] static std::string axes(ViewFrom from) {
        constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
        constexpr double kLength = 24;
        std::string svg;
        for (int axis = 0; axis < 3; ++axis) {
            Point along = Point::Zero();
            along[axis] = 1;
            const Place end = place_of(along, from);
            svg += "<path class=\"axis\" d=\"M0 0L" + coordinates(end, kLength) + "\"/>\n";
            svg += text_at(
                end[0] * (kLength + 8),
                -end[1] * (kLength + 8) + 4,
                kNames[static_cast<std::size_t>(axis)],
                " text-anchor=\"middle\""
            );
        }
        return svg;
    }

    // A whole file, whose pictures have cubes of this half-edge.
    [[nodiscard]] std::string file(
        double width,
        double height,
        double length,
        const std::string& title,
        const std::string& content
    ) const {
        std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                          svg_number(width) + " " + svg_number(height) + "\" width=\"" +
                          svg_number(width) + "\" height=\"" + svg_number(height) +
                          "\" class=\"figures\" role=\"img\">\n<title>" + svg_escaped(title) +
                          "</title>\n" + kStyle + "<defs>\n" + palette_.patterns();
        for (const ViewFrom from : {ViewFrom::kFront, ViewFrom::kBack}) {
            const CubeEdges cube = cube_edges(from);
            svg += "<g id=\"" + cube_name("behind", from) + "\">" +
                   path("cube", cube.behind, length) + "</g>\n";
            svg += "<g id=\"" + cube_name("rest", from) + "\">" + path("cube", cube.rest, length) +
                   "</g>\n";
        }
        return svg + "</defs>\n" + content + "</svg>\n";
    }

  private:
    static std::string cube_name(const char* part, ViewFrom from) {
        return std::string("cube-") + part + (from == ViewFrom::kFront ? "-front" : "-back");
    }

    static std::string used(const char* part, ViewFrom from) {
        return "<use href=\"#" + cube_name(part, from) + "\"/>\n";
    }

    static std::string painted(const std::string& paint, const std::string& outlines) {
        return "<path class=\"face\" fill=\"" + paint + "\" stroke=\"" + paint + "\" d=\"" +
               outlines + "\"/>\n";
    }

    static std::string outline(const std::vector<Place>& places, double length) {
        std::string text;
        for (const Place& place : places) {
            text += (text.empty() ? "M" : "L") + coordinates(place, length);
        }
        return text + "z";
    }

    static std::string coordinates(const Place& place, double length) {
        return svg_number(place[0] * length) + " " + svg_number(-place[1] * length);
    }

    static std::string path(const char* kind, const std::vector<Stroke>& strokes, double length) {
        if (strokes.empty()) {
            return "";
        }
        std::vector<std::pair<std::string, std::string>> lines;  // each once, whichever way round
        for (const auto& [from, to] : strokes) {
            std::string a = coordinates(from, length);
            std::string b = coordinates(to, length);
            if (b < a) {
                std::swap(a, b);
            }
            lines.emplace_back(std::move(a), std::move(b));
        }
        std::sort(lines.begin(), lines.end());
        lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
        std::string svg = std::string("<path class=\"") + kind + "\" d=\"";
        for (const auto& [from, to] : lines) {
            svg += "M" + from + "L" + to;
        }
        return svg + "\"/>\n";
    }

    [[nodiscard]] std::string swatch(double x, double y, ObjectId object) const {
        return "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y + 3) + "\" width=\"" +
               svg_number(kSwatch) + "\" height=\"" + svg_number(kSwatch) + "\" fill=\"" +
               palette_.plain(object) + "\" stroke=\"#222\" stroke-width=\"0.6\"/>\n";
    }

    std::vector<std::pair<ObjectId, std::string>> texts(std::size_t number, bool with_names) {
        const Figure& figure = figures_.at(static_cast<Label>(number));
        std::vector<std::pair<ObjectId, std::string>> list;
        for (const ObjectId object : objects_in(figure)) {
            const std::string& name = reading_.example().objects[object - 1U].name;
            list.emplace_back(
                object,
                (with_names ? shortened(name, kNameBytesMax) + ": " : "") +
                    writer_.write(figure, object).value_or("(too long)")
            );
        }
        return list;
    }

    const ExampleReading& reading_;
    const Figures& figures_;
    FigurePalette palette_;
    ExpressionWriter writer_;
};

std::string moved(double x, double y, const std::string& svg, const std::string& title = "") {
    return "<g transform=\"translate(" + svg_number(x) + " " + svg_number(y) + ")\">\n" +
           (title.empty() ? "" : "<title>" + svg_escaped(title) + "</title>\n") + svg + "</g>\n";
}

// Puts parts below each other.
class Column {
  public:
    Column(double x, double y) : x_(x), y_(y) {}

    void add(const Part& part, double gap) {
        svg_ += moved(x_, y_, part.svg);
        y_ += part.height + gap;
    }

    [[nodiscard]] double y() const { return y_; }

    [[nodiscard]] const std::string& svg() const { return svg_; }

  private:
    double x_;
    double y_;
    std::string svg_;
};

// The figures of one rank as rows of pictures with their captions.
class Table {
  public:
    static constexpr std::size_t kColumns = 5;
    static constexpr double kColumn = 210;
    static constexpr double kLength = 34;  // of the cubes' half-edges

    explicit Table(Drawing& drawing) : drawing_(drawing) {}

    [[nodiscard]] Part draw(const std::string& heading, std::span<const std::size_t> numbers) {
        Part part = {text_at(0, kLine, heading, " class=\"rank\""), kLine + 8};
        for (std::size_t first = 0; first < numbers.size(); first += kColumns) {
            const std::size_t count = std::min(kColumns, numbers.size() - first);
            double height = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const Part one = draw_one(numbers[first + i]);
                part.svg += moved(
                    kColumn * static_cast<double>(i),
                    part.height,
                    one.svg,
                    drawing_.description(numbers[first + i])
                );
                height = std::max(height, one.height);
            }
            part.height += height + 14;
        }
        return part;
    }

  private:
    [[nodiscard]] Part draw_one(std::size_t number) {
        constexpr double kPicture = 112;
        constexpr double kMiddle = 47;
        const Part caption = drawing_.caption(number, kColumn - 12, false);
        return {
            moved(kMiddle, kPicture / 2, drawing_.picture(number, ViewFrom::kFront, kLength)) +
                moved(
                    3 * kMiddle + 6,
                    kPicture / 2,
                    drawing_.picture(number, ViewFrom::kBack, kLength)
                ) +
                text_at(0, 11, std::to_string(number)) + moved(0, kPicture, caption.svg),
            kPicture + caption.height};
    }

    Drawing& drawing_;
};

// As many figures by rank and number as a sheet holds.
std::vector<std::size_t> on_sheet(const Drawing& drawing, const Figures& figures) {
    std::vector<std::pair<int, std::size_t>> ranked;
    for (std::size_t number = 0; number < figures.count(); ++number) {
        ranked.emplace_back(-drawing.rank(number), number);
    }
    std::sort(ranked.begin(), ranked.end());
    constexpr std::size_t kPlanesMax = 8;  // as if each had so many
    constexpr std::size_t kWorkMax = kFiguresOnSheetMax * kPlanesMax * kPlanesMax * kPlanesMax;
    std::vector<std::size_t> numbers;
    std::size_t work = 0;
    for (const auto& [rank, number] : ranked) {
        const auto planes =
            static_cast<std::size_t>(std::popcount(figures.relevant(static_cast<Label>(number))));
        work += planes * planes * planes;
        if (numbers.size() == kFiguresOnSheetMax || work > kWorkMax) {
            break;
        }
        numbers.push_back(number);
    }
    return numbers;
}

}  // namespace

std::string draw_figure(const ExampleReading& reading, std::size_t number) {
    constexpr double kWidth = 470;
    constexpr double kLength = 76;
    constexpr double kPicture = 250;
    constexpr double kMiddle = kWidth / 4;
    check(number < reading.figures().count(), "there is no figure of this number");
    Drawing drawing(reading);
    const std::string title = shortened(reading.example().name, kNameBytesMax) + ", figure " +
                              std::to_string(number) + ": " +
                              kRankNames[static_cast<std::size_t>(drawing.rank(number))];
    Column column(kMargin, kMargin);
    column.add({text_at(0, kLine, title, " class=\"title\""), kLine}, 10);
    Part pictures = {"", kPicture + 2 * kLine};
    for (const ViewFrom from : {ViewFrom::kFront, ViewFrom::kBack}) {
        const bool is_front = from == ViewFrom::kFront;
        const double x = (is_front ? kMiddle : 3 * kMiddle) - kMargin;
        pictures.svg += moved(x, kPicture / 2, drawing.picture(number, from, kLength));
        pictures.svg += moved(x - 84, kPicture, Drawing::axes(from));
        pictures.svg += text_at(
            x - 40, kPicture + kLine, is_front ? "from the front, above" : "from behind, below"
        );
    }
    column.add(pictures, 8);
    column.add(drawing.caption(number, kWidth - 2 * kMargin, true), 8);
    const FamilySet families = reading.figures().relevant(static_cast<Label>(number));
    if (families != 0) {
        column.add(drawing.half_spaces(families, kWidth - 2 * kMargin), 0);
    }
    return drawing.file(
        kWidth, column.y() + kMargin, kLength, drawing.description(number), column.svg()
    );
}

std::string draw_figure_sheet(const ExampleReading& reading) {
    constexpr double kWidth = Table::kColumns * Table::kColumn + kMargin;
    constexpr double kAxes = 90;
    const std::size_t count = reading.figures().count();
    Drawing drawing(reading);
    const auto numbers = on_sheet(drawing, reading.figures());
    std::string title = "Figures of " + shortened(reading.example().name, kNameBytesMax) + ": ";
    title += numbers.size() < count
                 ? "the first " + std::to_string(numbers.size()) + " of " + std::to_string(count)
                 : "all " + std::to_string(count);
    Column column(kMargin, kMargin);
    column.add({text_at(0, kLine, title, " class=\"title\""), kLine}, 12);
    const double top = column.y();
    column.add(drawing.objects(kWidth - kAxes), 8);
    column.add(drawing.half_spaces(~FamilySet{0}, kWidth - kAxes), 14);
    Table table(drawing);
    for (std::size_t first = 0; first < numbers.size();) {
        const int rank = drawing.rank(numbers[first]);
        std::size_t end = first;
        while (end < numbers.size() && drawing.rank(numbers[end]) == rank) {
            ++end;
        }
        column.add(
            table.draw(
                kRankHeadings[static_cast<std::size_t>(rank)],
                std::span(numbers).subspan(first, end - first)
            ),
            6
        );
        first = end;
    }
    return drawing.file(
        kWidth,
        column.y() + kMargin,
        Table::kLength,
        title,
        moved(kWidth - kAxes / 2 - kMargin, top + 30, Drawing::axes(ViewFrom::kFront)) +
            column.svg()
    );
}

}  // namespace modelsynth::continuous

#include "solver/continuous/display/figure_pictures.h"

#include "solver/core/svg_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace modelsynth::continuous {

namespace {

constexpr double kLetter = 6.6;  // how wide a letter is, generously
constexpr double kSwatch = 9;
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

}  // namespace

const char* name_of_rank(int rank) { return kRankNames[static_cast<std::size_t>(rank)]; }

std::string text_at(double x, double y, const std::string& text, const char* attributes) {
    return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\"" + attributes + ">" +
           svg_escaped(text) + "</text>\n";
}

int Drawing::rank(std::size_t number) const {
    return rank_of(reading_.topes(), figures_.relevant(static_cast<Label>(number)));
}

std::string Drawing::picture(std::size_t number, ViewFrom from, double length) {
    const auto label = static_cast<Label>(number);
    const FigureView view =
        view_figure(reading_.topes(), figures_.at(label), figures_.relevant(label), from);
    std::string svg = used("behind", from);
    for (const FigurePiece& piece : view.surfaces) {
        svg +=
            painted(palette_.surface(piece.object, piece.normal), outline(piece.outline, length));
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

Part Drawing::caption(std::size_t number, double width, bool with_names) {
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

std::string Drawing::description(std::size_t number) {
    std::string text = std::to_string(number) + " " + name_of_rank(rank(number));
    for (const auto& [object, expression] : texts(number, true)) {
        text += "; " + expression;
    }
    return text;
}

Part Drawing::half_spaces(FamilySet families, double width) const {
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
            "h" + std::to_string(family + 1) + ": n = (" + decimal(n.x()) + ", " + decimal(n.y()) +
                ", " + decimal(n.z()) + ")"
        );
        ++shown;
    }
    part.height = kLine * static_cast<double>((shown + columns - 1) / columns + 1);
    return part;
}

Part Drawing::objects(double width) const {
    constexpr double kColumn = 185;
    constexpr std::size_t kColumnBytes = 20;
    Part part;
    const auto columns = static_cast<std::size_t>(std::max(1.0, width / kColumn));
    const auto& all = reading_.example().objects;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double x = kColumn * static_cast<double>(i % columns);
        const double y = kLine * static_cast<double>(i / columns);
        part.svg += swatch(x, y, static_cast<ObjectId>(i + 1));
        part.svg += text_at(x + kSwatch + 5, y + kLine - 3, shortened(all[i].name, kColumnBytes));
    }
    part.height = kLine * static_cast<double>((all.size() + columns - 1) / columns);
    return part;
}

std::string Drawing::axes(ViewFrom from) {
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

std::string Drawing::file(
    double width, double height, double length, const std::string& title, const std::string& content
) const {
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                      svg_number(width) + " " + svg_number(height) + "\" width=\"" +
                      svg_number(width) + "\" height=\"" + svg_number(height) +
                      "\" class=\"figures\" role=\"img\">\n<title>" + svg_escaped(title) +
                      "</title>\n" + kStyle + "<defs>\n" + palette_.patterns();
    for (const ViewFrom from : {ViewFrom::kFront, ViewFrom::kBack}) {
        const CubeEdges cube = cube_edges(from);
        svg += "<g id=\"" + cube_name("behind", from) + "\">" + path("cube", cube.behind, length) +
               "</g>\n";
        svg += "<g id=\"" + cube_name("rest", from) + "\">" + path("cube", cube.rest, length) +
               "</g>\n";
    }
    return svg + "</defs>\n" + content + "</svg>\n";
}

std::string Drawing::cube_name(const char* part, ViewFrom from) {
    return std::string("cube-") + part + (from == ViewFrom::kFront ? "-front" : "-back");
}

std::string Drawing::used(const char* part, ViewFrom from) {
    return "<use href=\"#" + cube_name(part, from) + "\"/>\n";
}

std::string Drawing::painted(const std::string& paint, const std::string& outlines) {
    return "<path class=\"face\" fill=\"" + paint + "\" stroke=\"" + paint + "\" d=\"" + outlines +
           "\"/>\n";
}

std::string Drawing::outline(const std::vector<Place>& places, double length) {
    std::string text;
    for (const Place& place : places) {
        text += (text.empty() ? "M" : "L") + coordinates(place, length);
    }
    return text + "z";
}

std::string Drawing::coordinates(const Place& place, double length) {
    return svg_number(place[0] * length) + " " + svg_number(-place[1] * length);
}

std::string Drawing::path(const char* kind, const std::vector<Stroke>& strokes, double length) {
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

std::string Drawing::swatch(double x, double y, ObjectId object) const {
    return "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y + 3) + "\" width=\"" +
           svg_number(kSwatch) + "\" height=\"" + svg_number(kSwatch) + "\" fill=\"" +
           palette_.plain(object) + "\" stroke=\"#222\" stroke-width=\"0.6\"/>\n";
}

std::vector<std::pair<ObjectId, std::string>> Drawing::texts(std::size_t number, bool with_names) {
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

}  // namespace modelsynth::continuous

#pragma once

// Private to the drawings of figures.

#include "solver/continuous/display/expressions.h"
#include "solver/continuous/display/figure_palette.h"
#include "solver/continuous/display/figure_view.h"
#include "solver/continuous/reading/reading.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

inline constexpr double kLine = 15;  // from line to line of text
inline constexpr std::size_t kNameBytesMax = 40;

// A part of the drawing: what it is, and how much of the height it takes.
struct Part {
    std::string svg;
    double height = 0;
};

// Pictures and captions of an example's figures, and what their file needs besides.
class Drawing {
  public:
    explicit Drawing(const ExampleReading& reading)
        : reading_(reading),
          figures_(reading.figures()),
          palette_(reading.example()),
          writer_(reading.topes()) {}

    [[nodiscard]] int rank(std::size_t number) const;

    // Around 0, 0; the cube's half-edges have this length.
    [[nodiscard]] std::string picture(std::size_t number, ViewFrom from, double length);

    // Each object with where it stands, below y = 0.
    [[nodiscard]] Part caption(std::size_t number, double width, bool with_names);

    // "3 corner; wall: h1 ∧ h2; grass: ¬h1".
    [[nodiscard]] std::string description(std::size_t number);

    // What the half-spaces of some families are, in columns.
    [[nodiscard]] Part half_spaces(FamilySet families, double width) const;

    // The objects by colour, in columns.
    [[nodiscard]] Part objects(double width) const;

    // Where x, y and z point to, around 0, 0.
    [[nodiscard]] static std::string axes(ViewFrom from);

    // A whole file, whose pictures have cubes of this half-edge.
    [[nodiscard]] std::string file(
        double width,
        double height,
        double length,
        const std::string& title,
        const std::string& content
    ) const;

  private:
    static std::string cube_name(const char* part, ViewFrom from);

    static std::string used(const char* part, ViewFrom from);

    static std::string painted(const std::string& paint, const std::string& outlines);

    static std::string outline(const std::vector<Place>& places, double length);

    static std::string coordinates(const Place& place, double length);

    static std::string path(const char* kind, const std::vector<Stroke>& strokes, double length);

    [[nodiscard]] std::string swatch(double x, double y, ObjectId object) const;

    [[nodiscard]] std::vector<std::pair<ObjectId, std::string>> texts(
        std::size_t number, bool with_names
    );

    const ExampleReading& reading_;
    const Figures& figures_;
    FigurePalette palette_;
    ExpressionWriter writer_;
};

// "corner", ...; by rank.
[[nodiscard]] const char* name_of_rank(int rank);

// A text at a place, with more attributes of its element.
[[nodiscard]] std::string text_at(
    double x, double y, const std::string& text, const char* attributes = ""
);

}  // namespace modelsynth::continuous

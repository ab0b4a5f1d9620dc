#include "solver/discrete/analysis/success_drawing.h"

#include "solver/core/svg_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace modelsynth::discrete {

namespace {

// The field of the curves, in units of the drawing.
constexpr double kLeft = 70;
constexpr double kRight = 500;
constexpr double kTop = 30;
constexpr double kBottom = 330;
constexpr double kLegendLeft = 520;
constexpr double kLegendLine = 24;
constexpr std::size_t kStyleCount = 6;
constexpr std::size_t kNameLengthMax = 14;  // bytes that fit beside the legend's lines

constexpr std::array<const char*, kStyleCount> kDashes = {
    "none", "7 4", "2 4", "11 4 2 4", "14 5", "5 3 1 3"};

// Colours of about equal contrast, on white and on near-black.
constexpr const char* kStyle =
    "<style>\n"
    ".success { color: #222; background: #fff; font: 13px system-ui, sans-serif; }\n"
    ".success text { fill: currentColor; }\n"
    ".success .grid { stroke: currentColor; stroke-opacity: 0.18; }\n"
    ".success .axis { stroke: currentColor; fill: none; }\n"
    ".success .line { fill: none; stroke-width: 2; }\n"
    ".success .bar { stroke-width: 1; stroke-opacity: 0.7; }\n"
    ".success .c0 { color: #1f5fa8; } .success .c1 { color: #b3541e; }\n"
    ".success .c2 { color: #24733a; } .success .c3 { color: #7a3fa0; }\n"
    ".success .c4 { color: #a3244f; } .success .c5 { color: #5d5d5d; }\n"
    "@media (prefers-color-scheme: dark) {\n"
    ".success { color: #e8e8e8; background: #161616; }\n"
    ".success .c0 { color: #7fb4f0; } .success .c1 { color: #f0a36b; }\n"
    ".success .c2 { color: #7fce92; } .success .c3 { color: #c79bf0; }\n"
    ".success .c4 { color: #f08fae; } .success .c5 { color: #b4b4b4; }\n"
    "}\n"
    "</style>\n";

std::string line(const char* kind, double x1, double y1, double x2, double y2) {
    return std::string("<line class=\"") + kind + "\" x1=\"" + svg_number(x1) + "\" y1=\"" +
           svg_number(y1) + "\" x2=\"" + svg_number(x2) + "\" y2=\"" + svg_number(y2) + "\"/>\n";
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
    return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" text-anchor=\"" + anchor +
           "\">" + text + "</text>\n";
}

// Where shares lie, bottom to top.
double height_of(double share) { return kBottom - (kBottom - kTop) * share; }

double share_of(const SuccessPoint& point) {
    return static_cast<double>(point.successes) / static_cast<double>(point.runs);
}

// Wilson's score interval: unlike the plain one it is not a point at 0 and at 1.
std::pair<double, double> confidence_of(const SuccessPoint& point) {
    constexpr double kDeviations = 1.96;
    const auto runs = static_cast<double>(point.runs);
    const double share = share_of(point);
    const double square = kDeviations * kDeviations;
    const double middle = share + square / (2 * runs);
    const double spread =
        kDeviations * std::sqrt(share * (1 - share) / runs + square / (4 * runs * runs));
    const double scale = 1 + square / runs;
    return {std::max(0.0, (middle - spread) / scale), std::min(1.0, (middle + spread) / scale)};
}

// Widths to the right; the axis begins at 0 and ends at a round number.
class Across {
  public:
    explicit Across(std::span<const SuccessCurve> curves) {
        std::int32_t widest = 1;
        for (const SuccessCurve& curve : curves) {
            for (const SuccessPoint& point : curve.points) {
                widest = std::max(widest, point.size.x);
            }
        }
        step_ = 1;
        // 1, 2, 5, 10, 20, 50, ...: at most ten steps.
        for (std::int32_t i = 0; (widest - 1) / step_ >= 10; ++i) {
            step_ = i % 3 == 1 ? step_ / 2 * 5 : step_ * 2;
        }
        steps_ = (widest - 1) / step_ + 1;
    }

    [[nodiscard]] std::int32_t steps() const { return steps_; }

    [[nodiscard]] std::int32_t width_at(std::int32_t step) const { return step * step_; }

    [[nodiscard]] double of(std::int32_t width) const {
        return kLeft + (kRight - kLeft) * static_cast<double>(width) /
                           (static_cast<double>(steps_) * static_cast<double>(step_));
    }

  private:
    std::int32_t step_ = 1;
    std::int32_t steps_ = 1;
};

std::string draw_axes(const Across& across) {
    constexpr std::int32_t kShareSteps = 5;
    std::string svg;
    for (std::int32_t i = 0; i <= kShareSteps; ++i) {
        const double y = height_of(static_cast<double>(i) / kShareSteps);
        svg += line("grid", kLeft, y, kRight, y);
        svg += text_at(kLeft - 8, y + 4, "end", std::to_string(100 / kShareSteps * i));
    }
    for (std::int32_t i = 0; i <= across.steps(); ++i) {
        const std::int32_t width = across.width_at(i);
        svg += line("grid", across.of(width), kTop, across.of(width), kBottom);
        svg += text_at(across.of(width), kBottom + 20, "middle", std::to_string(width));
    }
    svg += "<path class=\"axis\" d=\"M" + svg_number(kLeft) + " " + svg_number(kTop) + "V" +
           svg_number(kBottom) + "H" + svg_number(kRight) + "\"/>\n";
    svg += text_at(
        (kLeft + kRight) / 2, kBottom + 46, "middle", "width and depth of the model (cells)"
    );
    svg += "<text transform=\"translate(22 " + svg_number((kTop + kBottom) / 2) +
           ") rotate(-90)\" text-anchor=\"middle\">runs that succeed (%)</text>\n";
    return svg;
}

// A mark of its own for each style.
std::string mark(double x, double y, std::size_t style) {
    constexpr std::array<const char*, kStyleCount> kShapes = {
        "m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
        "m-4 -4h8v8h-8z",
        "m0 -5l5 9h-10z",
        "m0 -5l5 5l-5 5l-5 -5z",
        "m0 5l5 -9h-10z",
        "m-5 -2h10v4h-10z"};
    return "<path d=\"M" + svg_number(x) + " " + svg_number(y) + kShapes[style] +
           "\" fill=\"currentColor\"/>\n";
}

std::string draw_curve(const SuccessCurve& curve, const Across& across, std::size_t style) {
    std::string path;
    std::string marks;
    for (const SuccessPoint& point : curve.points) {
        const double x = across.of(point.size.x);
        const double y = height_of(share_of(point));
        const auto [low, high] = confidence_of(point);
        path += (path.empty() ? "M" : "L") + svg_number(x) + " " + svg_number(y);
        marks += "<path class=\"bar\" stroke=\"currentColor\" d=\"M" + svg_number(x) + " " +
                 svg_number(height_of(low)) + "V" + svg_number(height_of(high)) + "\"/>\n";
        marks += mark(x, y, style);
    }
    if (path.empty()) {
        return "";
    }
    return "<path class=\"line\" stroke=\"currentColor\" stroke-dasharray=\"" +
           std::string(kDashes[style]) + "\" d=\"" + path + "\"/>\n" + marks;
}

std::string draw_legend(const SuccessCurve& curve, std::size_t index, std::size_t style) {
    const double y = kTop + 10 + kLegendLine * static_cast<double>(index);
    return "<path class=\"line\" stroke=\"currentColor\" stroke-dasharray=\"" +
           std::string(kDashes[style]) + "\" d=\"M" + svg_number(kLegendLeft) + " " +
           svg_number(y) + "h26\"/>\n" + mark(kLegendLeft + 13, y, style) +
           text_at(
               kLegendLeft + 34, y + 4, "start", svg_escaped(shortened(curve.name, kNameLengthMax))
           );
}

}  // namespace

std::string draw_success_curves(std::span<const SuccessCurve> curves) {
    const Across across(curves);
    std::string svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 680 400\" class=\"success\" "
        "role=\"img\" "
        "aria-label=\"Share of runs that succeed by size of the model\">\n";
    svg += kStyle;
    svg += draw_axes(across);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::size_t style = i % kStyleCount;
        svg += "<g class=\"c" + std::to_string(style) + "\">\n<title>" +
               svg_escaped(curves[i].name) + "</title>\n";
        svg += draw_curve(curves[i], across, style);
        svg += draw_legend(curves[i], i, style);
        svg += "</g>\n";
    }
    return svg + "</svg>\n";
}

}  // namespace modelsynth::discrete

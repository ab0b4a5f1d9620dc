#include "solver/continuous/display/figure_drawing.h"

#include "solver/continuous/display/figure_pictures.h"
#include "solver/core/svg_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

constexpr double kMargin = 12;

constexpr std::array<const char*, 4> kRankHeadings = {"Insides", "Faces", "Edges", "Corners"};

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
                              std::to_string(number) + ": " + name_of_rank(drawing.rank(number));
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

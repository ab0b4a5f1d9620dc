#include "solver/examples/city_layout.h"

#include "solver/core/result.h"
#include "solver/examples/kit/mesh_builder.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace modelsynth::examples {

namespace {

// Sides in the order of quarter turns.
constexpr int kSideCount = 4;
constexpr std::array<int, kSideCount> kStepX = {1, 0, -1, 0};
constexpr std::array<int, kSideCount> kStepZ = {0, -1, 0, 1};

struct Place {
    int x = 0;
    int z = 0;

    [[nodiscard]] Place next(int side) const {
        const auto index = static_cast<std::size_t>(side % kSideCount);
        return {x + kStepX[index], z + kStepZ[index]};
    }
};

// Sides of a cell, one bit each.
class Sides {
  public:
    void insert(int side) { bits_ |= 1U << side; }

    [[nodiscard]] bool contains(int side) const { return (bits_ >> (side % kSideCount) & 1U) != 0; }

    [[nodiscard]] int count() const {
        int count = 0;
        for (int side = 0; side < kSideCount; ++side) {
            count += int{contains(side)};
        }
        return count;
    }

    // The side that comes first counter-clockwise, of one side or of two that meet.
    [[nodiscard]] int first() const {
        for (int side = 0; side < kSideCount; ++side) {
            if (contains(side) && !contains(side + kSideCount - 1)) {
                return side;
            }
        }
        return 0;
    }

    [[nodiscard]] bool is_corner() const { return count() == 2 && contains(first() + 1); }

  private:
    unsigned bits_ = 0;
};

char of_side(const Turned& letters, int side) {
    return letters[static_cast<std::size_t>(side % kSideCount)];
}

bool is_one_of(char letter, std::string_view letters) {
    return letters.find(letter) != std::string_view::npos;
}

bool is_street(char use) { return is_one_of(use, "#=zk"); }

bool is_lawn(char use) { return is_one_of(use, "gTSO"); }

bool is_brick(char use) { return use >= 'A' && use <= 'H'; }

bool is_block(char use) { return (use >= '1' && use <= '8') || is_brick(use); }

bool is_house(char use) { return use >= 'a' && use <= 'c'; }

// The plan in its four turns.
class Plan {
  public:
    explicit Plan(const std::vector<std::string_view>& quarter)
        : size_(2 * static_cast<int>(quarter.size())) {
        const auto n = static_cast<int>(quarter.size());
        uses_.assign(
            static_cast<std::size_t>(size_), std::string(static_cast<std::size_t>(size_), ' ')
        );
        for (int z = 0; z < n; ++z) {
            check(
                quarter[static_cast<std::size_t>(z)].size() == quarter.size(),
                "a city plan that is not square"
            );
            for (int x = 0; x < n; ++x) {
                Place place = {x, z};
                for (int turn = 0; turn < kSideCount; ++turn) {
                    set(place, quarter[static_cast<std::size_t>(z)][static_cast<std::size_t>(x)]);
                    place = {size_ - 1 - place.z, place.x};
                }
            }
        }
    }

    [[nodiscard]] int size() const { return size_; }

    [[nodiscard]] bool contains(const Place& at) const {
        return at.x >= 0 && at.x < size_ && at.z >= 0 && at.z < size_;
    }

    // What stands at a place; paving outside.
    [[nodiscard]] char use(const Place& at) const {
        return contains(at) ? uses_[static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.x)]
                            : '.';
    }

    [[nodiscard]] int storeys(const Place& at) const {
        const char use = this->use(at);
        return is_brick(use)   ? use - 'A' + 1
               : is_block(use) ? use - '0'
               : is_house(use) ? use - 'a' + 1
                               : 0;
    }

    // The sides at which what `is_same` accepts ends.
    template <class Predicate>
    [[nodiscard]] Sides sides_without(const Place& at, const Predicate& is_same) const {
        Sides sides;
        for (int side = 0; side < kSideCount; ++side) {
            if (!is_same(at.next(side))) {
                sides.insert(side);
            }
        }
        return sides;
    }

    // Cells of a house in a row through the place, along x (axis 0) or z (axis 1).
    [[nodiscard]] int house_length(const Place& at, int axis) const {
        int length = 1;
        for (const int side : {axis, axis + 2}) {
            for (Place next = at.next(side); is_house(use(next)); next = next.next(side)) {
                ++length;
            }
        }
        return length;
    }

  private:
    void set(const Place& at, char use) {
        uses_[static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.x)] = use;
    }

    int size_;
    std::vector<std::string> uses_;
};

// Chooses the letter of each cell of the plan.
class LetterChoice {
  public:
    LetterChoice(const Plan& plan, const CityLetters& letters) : plan_(plan), letters_(letters) {}

    [[nodiscard]] char at(const Place& place, int floor) const {
        const char use = plan_.use(place);
        if (is_block(use)) {
            return block(place, floor);
        }
        if (is_house(use)) {
            return house(place, floor);
        }
        if (floor > 0) {
            return letters_.open.air;
        }
        return is_street(use) ? street(place) : is_lawn(use) ? lawn(place) : paving(use);
    }

  private:
    // True for about `share` of all places; which does not matter, only that it is the same always.
    static bool drawn(const Place& place, int floor, float share) {
        const auto seed = static_cast<std::uint32_t>(place.x * 64 + place.z);
        return scatter(seed, static_cast<std::uint32_t>(floor)) < share;
    }

    [[nodiscard]] char paving(char use) const {
        const OpenLetters& open = letters_.open;
        switch (use) {
            case 'l':
                return open.lamp;
            case 't':
                return open.tree;
            case 'n':
                return open.bench;
            case 'p':
                return open.puddle;
            default:
                check(use == '.', "a city plan with a letter that means nothing");
                return open.paving;
        }
    }

    [[nodiscard]] char lawn(const Place& place) const {
        const OpenLetters& open = letters_.open;
        const Sides ends = plan_.sides_without(place, [this](const Place& next) {
            return is_lawn(plan_.use(next));
        });
        if (ends.count() == 0) {
            const char use = plan_.use(place);
            return use == 'T'   ? open.lawn_tree
                   : use == 'S' ? open.lawn_shrubs
                   : use == 'O' ? open.fountain
                                : open.lawn;
        }
        check(ends.count() == 1 || ends.is_corner(), "a lawn less than two cells wide");
        return of_side(ends.count() == 1 ? open.lawn_edge : open.lawn_corner, ends.first());
    }

    // Streets run on where they meet the end of the plan.
    [[nodiscard]] char street(const Place& place) const {
        const StreetLetters& street = letters_.street;
        const Sides ends = plan_.sides_without(place, [&](const Place& next) {
            const Place behind = {2 * place.x - next.x, 2 * place.z - next.z};
            return is_street(plan_.use(plan_.contains(next) ? next : behind));
        });
        if (ends.count() == 0) {
            return street.crossing;
        }
        if (ends.count() == 1) {
            return of_side(street.fork, ends.first());
        }
        if (ends.is_corner()) {
            return of_side(street.turn, ends.first() + 2);
        }
        check(ends.count() == 2, "a street that ends");
        const char use = plan_.use(place);
        const Axial& letters = use == '='   ? street.lamps
                               : use == 'z' ? street.zebra
                               : use == 'k' ? street.car
                                            : street.plain;
        return letters[ends.contains(0) ? 1 : 0];
    }

    // Doors lead to where one can walk.
    [[nodiscard]] bool has_door(const Place& place, int side) const {
        const char front = plan_.use(place.next(side));
        return (is_street(front) || is_one_of(front, ".p")) && drawn(place, 0, 0.4F);
    }

    [[nodiscard]] char block(const Place& place, int floor) const {
        const int storeys = plan_.storeys(place);
        if (floor > storeys) {
            return letters_.open.air;
        }
        return floor == storeys ? block_roof(place, floor) : block_storey(place, floor);
    }

    [[nodiscard]] char block_storey(const Place& place, int floor) const {
        const BlockLetters& block = letters_.block;
        const Sides faces = plan_.sides_without(place, [&](const Place& next) {
            return plan_.storeys(next) > floor;
        });
        check(
            faces.count() < 2 || faces.is_corner(),
            "a block less than two cells wide in a city plan"
        );
        const int side = faces.first();
        if (faces.count() == 0) {
            return floor == 0 ? block.ground_core : block.core;
        }
        if (floor == 0) {
            return of_side(
                faces.count() == 2      ? block.ground_corner
                : has_door(place, side) ? block.door
                                        : block.shop,
                side
            );
        }
        const auto meets_roof = [&](int towards) {
            return faces.contains(towards) && plan_.storeys(place.next(towards)) == floor;
        };
        if (faces.count() == 1 && meets_roof(side)) {
            return of_side(block.terrace, side);
        }
        if (meets_roof(side) || meets_roof(side + 1)) {
            return meets_roof(side) ? of_side(block.terrace_left, side)
                                    : of_side(block.terrace_right, side + 1);
        }
        const bool brick = is_brick(plan_.use(place));
        if (faces.count() == 2) {
            return of_side(brick ? block.brick_corner : block.corner, side);
        }
        if (drawn(place, floor, 0.5F)) {
            return of_side(brick ? block.lit_brick_wall : block.lit_wall, side);
        }
        return of_side(brick ? block.brick_wall : block.wall, side);
    }

    [[nodiscard]] char block_roof(const Place& place, int floor) const {
        const BlockLetters& block = letters_.block;
        const Sides edges = plan_.sides_without(place, [&](const Place& next) {
            return plan_.storeys(next) >= floor;
        });
        if (edges.count() == 0) {
            return drawn(place, 1, 0.55F)  ? block.roof
                   : drawn(place, 2, 0.4F) ? block.roof_tank
                   : drawn(place, 3, 0.5F) ? block.roof_mast
                                           : block.roof_light;
        }
        const Turned& corner =
            drawn(place, floor, 0.35F) ? block.parapet_tank : block.parapet_corner;
        return of_side(
            edges.count() == 2          ? corner
            : drawn(place, floor, 0.4F) ? block.parapet_stack
                                        : block.parapet,
            edges.first()
        );
    }

    [[nodiscard]] char house(const Place& place, int floor) const {
        const HouseLetters& house = letters_.house;
        const int storeys = plan_.storeys(place);
        if (floor > storeys) {
            return letters_.open.air;
        }
        const Sides faces = plan_.sides_without(place, [&](const Place& next) {
            return is_house(plan_.use(next));
        });
        check(faces.count() == 1 || faces.is_corner(), "a house that is not two cells deep");
        const int side = faces.first();
        const bool is_corner = faces.count() == 2;
        if (floor == storeys) {
            if (!is_corner) {
                return of_side(drawn(place, floor, 0.4F) ? house.dormer : house.slope, side);
            }
            const int ridge_axis = plan_.house_length(place, 0) < plan_.house_length(place, 1);
            // A slope looks across the ridge: along z where the ridge runs along x.
            const bool first_is_slope = side % 2 != ridge_axis;
            return first_is_slope ? of_side(house.gable_left, side)
                                  : of_side(house.gable_right, side + 1);
        }
        if (floor > 0) {
            return of_side(is_corner ? house.corner : house.wall, side);
        }
        return of_side(
            is_corner               ? house.ground_corner
            : has_door(place, side) ? house.door
                                    : house.front,
            side
        );
    }

    const Plan& plan_;
    const CityLetters& letters_;
};

}  // namespace

std::vector<std::vector<std::string>> lay_out_city(
    const std::vector<std::string_view>& plan, int floor_count, const CityLetters& letters
) {
    const Plan whole(plan);
    const LetterChoice choice(whole, letters);
    std::vector<std::vector<std::string>> floors;
    for (int floor = 0; floor < floor_count; ++floor) {
        std::vector<std::string>& rows = floors.emplace_back();
        for (int z = 0; z < whole.size(); ++z) {
            std::string& row = rows.emplace_back();
            for (int x = 0; x < whole.size(); ++x) {
                row += choice.at({x, z}, floor);
            }
        }
    }
    return floors;
}

}  // namespace modelsynth::examples

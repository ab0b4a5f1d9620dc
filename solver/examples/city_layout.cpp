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

bool is_street(char use) { return use == '#'; }

bool is_brick(char use) { return use >= 'A' && use <= 'H'; }

bool is_mint(char use) { return use >= 'J' && use <= 'Q'; }

bool is_block(char use) { return (use >= '1' && use <= '8') || is_brick(use) || is_mint(use); }

bool is_house(char use) { return use >= 'a' && use <= 'c'; }

constexpr int kTowerStoreys = 4;

// The plan in its four turns about a street crossing.
class Plan {
  public:
    explicit Plan(const std::vector<std::string_view>& quarter)
        : size_(2 * static_cast<int>(quarter.size()) + 1),
          uses_(static_cast<std::size_t>(size_), std::string(static_cast<std::size_t>(size_), '#')),
          origins_(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_)) {
        const auto n = static_cast<int>(quarter.size());
        for (int z = 0; z < n; ++z) {
            const std::string_view row = quarter[static_cast<std::size_t>(z)];
            check(row.size() == quarter.size() + 1, "a city plan that is not one wider than deep");
            for (int x = 0; x <= n; ++x) {
                Place place = {x, z};
                for (int turn = 0; turn < kSideCount; ++turn) {
                    set(place, row[static_cast<std::size_t>(x)], {x, z});
                    place = {size_ - 1 - place.z, place.x};
                }
            }
        }
    }

    [[nodiscard]] int size() const { return size_; }

    [[nodiscard]] bool contains(const Place& at) const {
        return at.x >= 0 && at.x < size_ && at.z >= 0 && at.z < size_;
    }

    // What stands at a place; nothing outside.
    [[nodiscard]] char use(const Place& at) const {
        return contains(at) ? uses_[static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.x)]
                            : ' ';
    }

    // The place in the quarter of which this is a turn.
    [[nodiscard]] Place origin(const Place& at) const { return origins_[index(at)]; }

    [[nodiscard]] int storeys(const Place& at) const {
        const char use = this->use(at);
        return is_brick(use)   ? use - 'A' + 1
               : is_mint(use)  ? use - 'J' + 1
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

    // ... and of those that have the same letter.
    [[nodiscard]] Sides sides_of(const Place& at) const {
        return sides_without(at, [&](const Place& next) { return use(next) == use(at); });
    }

    // The sides a street leaves by.
    [[nodiscard]] Sides arms(const Place& at) const {
        return sides_without(at, [&](const Place& next) { return !is_street(use(next)); });
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
    void set(const Place& at, char use, const Place& origin) {
        uses_[static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.x)] = use;
        origins_[index(at)] = origin;
    }

    [[nodiscard]] std::size_t index(const Place& at) const {
        return static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size_) +
               static_cast<std::size_t>(at.x);
    }

    int size_;
    std::vector<std::string> uses_;
    std::vector<Place> origins_;
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
        if (use == 't') {
            return tower(place, floor);
        }
        if (floor > 0) {
            return letters_.air;
        }
        switch (use) {
            case '#':
                return street(place);
            case 'p':
                return open_place(place, letters_.park);
            case 'q':
                return open_place(place, letters_.square);
            case 'g':
                return garden(place);
            case 'v':
                return verge(place);
            case 'y':
                return yard(place);
            default:
                check(use == ':', "a city plan with a letter that means nothing");
                return lane(place);
        }
    }

  private:
    // True for about `share` of all places; which does not matter, only that it is the same always,
    // and in all four turns: what fits in one direction must fit in all.
    [[nodiscard]] bool drawn(const Place& place, int floor, float share) const {
        const Place origin = plan_.origin(place);
        const auto seed = static_cast<std::uint32_t>(origin.x * 64 + origin.z);
        return scatter(seed, static_cast<std::uint32_t>(floor)) < share;
    }

    [[nodiscard]] char street(const Place& place) const {
        const StreetLetters& street = letters_.street;
        const Sides arms = plan_.arms(place);
        switch (arms.count()) {
            case 4:
                return street.crossing;
            case 3:
                return of_side(street.fork, arms.first() + 3);
            case 1:
                return of_side(street.end, arms.first());
            default:
                check(arms.count() == 2, "a street that leads nowhere");
        }
        if (arms.is_corner()) {
            return of_side(street.turn, arms.first());
        }
        const int side = arms.contains(0) ? 0 : 1;
        for (const int towards : {side, side + 2}) {
            if (plan_.arms(place.next(towards)).count() > 2) {
                check(
                    plan_.arms(place.next(towards + 2)).count() == 2,
                    "junctions less than four cells apart in a city plan"
                );
                return of_side(street.zebra, towards);
            }
        }
        // Beside a turn always the same, so that a ring of any size closes.
        const bool is_beside_turn = plan_.arms(place.next(side)).is_corner() ||
                                    plan_.arms(place.next(side + 2)).is_corner();
        const Axial& letters = is_beside_turn           ? street.plain
                               : drawn(place, 4, 0.3F)  ? street.lamps
                               : drawn(place, 5, 0.35F) ? street.car
                                                        : street.plain;
        return letters[static_cast<std::size_t>(side)];
    }

    // Lanes run on into lanes; those that have none beside them, into streets. Some of their cells
    // are yards, as are all where lanes meet.
    [[nodiscard]] char lane(const Place& place) const {
        Sides ways = plan_.sides_without(place, [this](const Place& next) {
            return plan_.use(next) != ':';
        });
        if (ways.count() == 0) {
            ways = plan_.arms(place);
        }
        const bool along_x = ways.contains(0) || ways.contains(2);
        const bool along_z = ways.contains(1) || ways.contains(3);
        if ((along_x && along_z) || drawn(place, 9, 0.4F)) {
            return yard(place);
        }
        const Axial& letters = drawn(place, 0, 0.35F) ? letters_.lane.tree : letters_.lane.plain;
        return letters[along_x ? 0 : 1];
    }

    [[nodiscard]] char yard(const Place& place) const {
        return drawn(place, 10, 0.5F)   ? letters_.lane.yard
               : drawn(place, 11, 0.6F) ? letters_.lane.yard_tree
                                        : letters_.lane.yard_bench;
    }

    [[nodiscard]] char verge(const Place& place) const {
        for (int side = 0; side < kSideCount; ++side) {
            const char behind = plan_.use(place.next(side + 2));
            if (is_street(plan_.use(place.next(side))) &&
                (is_block(behind) || is_house(behind) || behind == 't')) {
                return of_side(letters_.lane.verge, side);
            }
        }
        check(false, "a verge that is not between a street and a building");
        return 0;
    }

    [[nodiscard]] char open_place(const Place& place, const PlaceLetters& letters) const {
        const Sides ends = plan_.sides_of(place);
        if (ends.count() == 1) {
            return of_side(letters.edge, ends.first());
        }
        if (ends.is_corner()) {
            return of_side(letters.corner, ends.first());
        }
        check(ends.count() == 0, "a place that is not three cells deep");
        const bool along_x = plan_.sides_of(place.next(0)).count() == 0 ||
                             plan_.sides_of(place.next(2)).count() == 0;
        const Place origin = plan_.origin(place);
        return (origin.x + origin.z) % 2 == 0 ? letters.middle[along_x ? 0 : 1] : letters.feature;
    }

    [[nodiscard]] char garden(const Place& place) const {
        const auto house_side = [&](const Place& at) {
            int side = 0;
            while (side < kSideCount && !is_house(plan_.use(at.next(side)))) {
                ++side;
            }
            return side;
        };
        const int house = house_side(place);
        check(house < kSideCount, "a garden without a house");
        const auto goes_on = [&](int side) {
            const Place next = place.next(side);
            return plan_.use(next) == 'g' && house_side(next) == house;
        };
        const int outward = house + 2;
        const HouseLetters& letters = letters_.house;
        return of_side(
            !goes_on(outward + 1)   ? letters.garden_left
            : !goes_on(outward + 3) ? letters.garden_right
                                    : letters.garden,
            outward
        );
    }

    [[nodiscard]] char block(const Place& place, int floor) const {
        const int storeys = plan_.storeys(place);
        if (floor > storeys) {
            return letters_.air;
        }
        const BlockLetters& block = letters_.block;
        const Sides faces = plan_.sides_of(place);
        check(
            faces.count() < 2 || faces.is_corner(),
            "a block less than two cells wide in a city plan"
        );
        const int side = faces.first();
        if (floor == storeys) {
            return block_roof(place, faces);
        }
        const bool along_z = plan_.sides_of(place.next(1)).count() == 0 ||
                             plan_.sides_of(place.next(3)).count() == 0;
        if (faces.count() == 0) {
            return floor == 0 ? block.ground_core[along_z ? 1 : 0] : block.core;
        }
        if (floor == 0) {
            return of_side(faces.count() == 2 ? block.ground_corner : block.shop, side);
        }
        const char use = plan_.use(place);
        const bool is_corner = faces.count() == 2;
        if (is_brick(use)) {
            return of_side(is_corner ? block.brick_corner : block.brick_wall, side);
        }
        if (is_mint(use)) {
            return of_side(is_corner ? block.mint_corner : block.mint_wall, side);
        }
        const Turned& wall = drawn(place, floor, 0.4F) ? block.balcony : block.wall;
        return of_side(is_corner ? block.corner : wall, side);
    }

    [[nodiscard]] char block_roof(const Place& place, const Sides& edges) const {
        const BlockLetters& block = letters_.block;
        if (edges.count() == 0) {
            return drawn(place, 1, 0.4F)   ? block.roof
                   : drawn(place, 2, 0.4F) ? block.roof_cupola
                   : drawn(place, 3, 0.5F) ? block.roof_garden
                                           : block.roof_light;
        }
        if (plan_.storeys(place) % 2 == 1) {
            return of_side(
                edges.count() == 2 ? block.tile_mansard_corner : block.tile_mansard, edges.first()
            );
        }
        return of_side(
            edges.count() == 2      ? block.mansard_corner
            : drawn(place, 1, 0.5F) ? block.mansard_dormer
                                    : block.mansard,
            edges.first()
        );
    }

    [[nodiscard]] char tower(const Place& place, int floor) const {
        const Sides faces = plan_.sides_of(place);
        check(faces.is_corner(), "a tower that is not two cells by two");
        const TowerLetters& tower = letters_.tower;
        if (floor > kTowerStoreys) {
            return letters_.air;
        }
        return of_side(
            floor == 0                   ? tower.ground
            : floor < kTowerStoreys - 1  ? tower.shaft
            : floor == kTowerStoreys - 1 ? tower.belfry
                                         : tower.spire,
            faces.first()
        );
    }

    [[nodiscard]] char house(const Place& place, int floor) const {
        const HouseLetters& house = letters_.house;
        const int storeys = plan_.storeys(place);
        if (floor > storeys) {
            return letters_.air;
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
        if (floor == 1) {
            return of_side(is_corner ? house.corner : house.wall, side);
        }
        if (floor == 2) {
            return of_side(is_corner ? house.timber_corner : house.timber_wall, side);
        }
        const bool is_back = plan_.use(place.next(side)) == 'g';
        return of_side(is_corner ? house.ground_corner : is_back ? house.back : house.front, side);
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

#include "compare/frame.hpp"
#include "packing/words.hpp"
#include "snap/backbone.hpp"
#include "snap/force_split.hpp"
#include "snap/soft_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::compare {

namespace {

/// Overlaps deeper than this, in smallest radii, do not belong to a packing of nearly rigid disks.
constexpr double deepest = 0.1;
/// Measured on frames in motion, 100 disks in LAMMPS: dashpots were 0.15 to 0.25 of the largest residual force.
constexpr double a_few = 10;
/// For frames without velocities. In slow motion with much drag the residual forces of the law were 3 % of those of the
/// files; at rest, with wrong forces of 5 %, less than 1e-4.
constexpr double in_motion = 3e-3;
/// When each disk's residual force is below this share of a wall's, the wall does not move.
constexpr double wall_alone = 1e-3;
/// The same share for two disks and the other disks.
constexpr double disk_alone = 1e-3;

class Reader {
  public:
    Reader(const Series& series, const Frame& frame)
        : series_(series), frame_(frame), law_{series.law, series.stiffness} {
        walls_listed_ = series.wall_forces ||
                        std::ranges::any_of(frame.contacts, [](const FileContact& c) { return is_wall(c.contact); });
        double largest = frame.packing.max_radius();
        for (int a = 0; a < frame.packing.dimension; ++a) {
            largest = std::max(largest, frame.packing.length(a));
        }
        rounding_ = std::max(frame.rounding, 0x1p-48 * largest);
        for (const Contact& c : near_contacts(frame.packing)) {
            if (gap(frame.packing, c) < 0) {
                overlaps_.push_back(c);
            }
            if (std::abs(gap(frame.packing, c)) <= frame.rounding && !has_rows(c)) {
                out_.unsure =
                    fmt::format("whether {} overlap is not told: gap {:.2g}, known to {:.2g} by the digits of "
                                "the files",
                                name(c), gap(frame.packing, c), frame.rounding);
            }
        }
    }

    Reading run() {
        take_rows();
        add_overlaps();
        out_.result.overlapping = static_cast<int>(overlaps_.size());
        double sum = 0;
        for (const auto& [contact, force] : force_) {
            sum += std::max(force, 0.0);
            out_.result.listed += force > 0 ? 1 : 0;
        }
        out_.mean = out_.result.listed > 0 ? sum / out_.result.listed : 0;
        check_overlaps();
        check_missing();
        balance();
        check_law();
        make_list();
        return std::move(out_);
    }

  private:
    template <class... Values> void contradict(fmt::format_string<Values...> what, Values&&... values) {
        out_.contradiction =
            out_.contradiction.empty() ? fmt::format(what, std::forward<Values>(values)...) : out_.contradiction;
    }
    [[nodiscard]] std::string name(const Contact& c) const {
        const auto id = [&](int i) { return frame_.ids[static_cast<std::size_t>(i)]; };
        if (c.of_disks()) {
            return fmt::format("{}s {} and {}", grain(), id(c.i), id(c.j));
        }
        return fmt::format("{} {} and the {} wall", grain(), id(c.i), wall_name(c));
    }
    [[nodiscard]] const char* grain() const { return grain_word(frame_.packing.dimension); }
    [[nodiscard]] std::string at(const Contact& c) const {
        const auto row = row_.find(c);
        const std::string where = row == row_.end() ? frame_.row : row->second;
        return c.of_disks() || where == frame_.row ? where : where + ", " + frame_.row;
    }
    [[nodiscard]] static bool is_wall(const Contact& c) { return !c.of_disks(); }
    /// Whether the files list contacts of this kind.
    [[nodiscard]] bool has_rows(const Contact& c) const { return is_wall(c) ? walls_listed_ : series_.listed; }

    void take_rows() {
        for (const FileContact& c : frame_.contacts) {
            const auto [row, added] = row_.emplace(c.contact, c.row);
            if (!added) {
                ++out_.result.twice;
                contradict("{}: {} come twice (first in {})", c.row, name(c.contact), row->second);
            } else if (c.force != 0) {
                force_.emplace(c.contact, c.force); // a negative force is that of a dashpot, or an error
                beyond_.emplace(c.contact, c.force - expected(c.contact));
            }
        }
    }

    /// Adds the overlaps of kinds of contacts that the files do not list.
    void add_overlaps() {
        for (const Contact& c : overlaps_) {
            if (!has_rows(c) && row_.emplace(c, frame_.row).second) {
                force_.emplace(c, expected(c));
            }
        }
    }

    void check_overlaps() {
        const double limit = deepest * frame_.packing.min_radius();
        for (const Contact& c : overlaps_) {
            if (gap(frame_.packing, c) < -limit) {
                contradict("{}: {} overlap by {:.3g}: expected less than {:.3g}, {} of the smallest radius (radii, or "
                           "diameters?)",
                           at(c), name(c), -gap(frame_.packing, c), limit, deepest);
                return;
            }
        }
        for (const auto& [c, force] : force_) {
            if (gap(frame_.packing, c) > limit) {
                contradict("{}: {} have a force and are {:.3g} apart", at(c), name(c), gap(frame_.packing, c));
                return;
            }
        }
    }

    void check_law() {
        if (series_.law == ForceLaw::none) {
            out_.result.law = std::numeric_limits<double>::quiet_NaN();
            return;
        }
        Contact worst;
        double largest = 0, rounded = 0, blur = 0;
        for (const auto& [c, force] : force_) {
            const double off = std::abs(force - expected(c)), known = off - unknown(c);
            blur = std::max(blur, unknown(c));
            rounded = std::max(rounded, known <= series_.agreement * out_.mean ? off : 0);
            if (known > largest) {
                largest = known;
                worst = c;
            }
        }
        out_.result.law = out_.mean > 0 ? largest / out_.mean : 0;
        out_.result.ratio = largest > 0 ? force_.at(worst) / expected(worst) : 1;
        if (largest <= series_.agreement * out_.mean) {
            note_rounding(rounded);
            return;
        }
        if (const auto dashpot = find_dashpot(frame_, beyond_, series_.law, series_.agreement * out_.mean + blur)) {
            out_.dashpots = dashpot->words();
        } else if (may_be_dashpots(largest)) {
            out_.dashpots = "dashpots may be at work";
        } else {
            contradict("{}: the force between {} is {:.6g} and {} {:.6g} (ratio {:.6g}){}", at(worst), name(worst),
                       force_.at(worst), series_.law == ForceLaw::linear ? "stiffness x overlap" : "that of the law",
                       expected(worst), out_.result.ratio, units_words());
        }
    }

    /// Describes a factor when most forces of the files differ from those of the law.
    [[nodiscard]] std::string units_words() const {
        std::vector<double> said, exact;
        int off = 0;
        for (const auto& [c, beyond] : beyond_) {
            said.push_back(force_.at(c));
            exact.push_back(expected(c));
            off += std::abs(beyond) > series_.agreement * out_.mean ? 1 : -1;
        }
        return off > 0 ? "; " + units_of(said, exact, out_.mean).words(series_.agreement) : "";
    }

    /// A dashpot adds at most a few times the residual force that accelerates the grains. In motion the residual forces
    /// are larger than those of a frame at rest, with the forces of the files and with those of the law.
    [[nodiscard]] bool may_be_dashpots(double largest) const {
        const double less = std::min(left_, left_by_law_), more = std::max(left_, left_by_law_);
        const bool moving = less > series_.rest * out_.mean || (frame_.velocity.empty() && less > in_motion * more);
        return moving && largest <= a_few * left_;
    }

    void note_rounding(double rounded) {
        if (rounded > series_.agreement * out_.mean) {
            out_.rounding =
                fmt::format("forces differ from those of the law by up to {:.2g} mean forces, as the digits "
                            "of the files let them",
                            rounded / out_.mean);
        }
    }

    /// Names overlaps that would carry a force by the law and have no row.
    void check_missing() {
        for (const Contact& c : overlaps_) {
            const bool law = series_.law != ForceLaw::none;
            const double force = law ? expected(c) - unknown(c) : 0;
            if (row_.count(c) == 0 && force > series_.agreement * out_.mean) {
                ++out_.result.missing_rows;
                contradict("{}: {} overlap by {:.6g}, a force of {:.6g}, and have no contact in the files", frame_.row,
                           name(c), -gap(frame_.packing, c), expected(c));
            }
        }
    }

    /// The force by the law.
    [[nodiscard]] double expected(const Contact& c) const { return law_.force(frame_.packing, c); }
    [[nodiscard]] double unknown(const Contact& c) const { return law_.rounding(frame_.packing, c, rounding_); }

    /// The largest residual forces on a disk, on the upper walls and on a tilt.
    struct Left {
        double disks = 0;
        std::vector<double> disk; ///< of each disk
        PerAxis<double> walls{};
        double tilt = 0; ///< of a cell with moving tilts
        [[nodiscard]] double largest() const { return std::max({disks, walls[0], walls[1], walls[2], tilt}); }
    };
    [[nodiscard]] Left left_by(const std::map<Contact, double>& forces) const {
        std::vector<double> left = frame_.load.external_force(frame_.packing);
        for (const auto& [c, force] : forces) {
            gap_gradient(frame_.packing, c).for_each([&left, f = force](std::size_t k, double push) {
                left[k] += f * push;
            });
        }
        const Packing& packing = frame_.packing;
        const std::size_t d = packing.axes();
        Left out;
        for (std::size_t a = 0; a < d; ++a) {
            out.walls[a] = std::abs(left[packing.length_at(a)]);
        }
        for (std::size_t t = 0; packing.cell.any() && t < packing.tilts(); ++t) {
            const double off = std::abs(left[packing.length_at(d + t)]);
            out.tilt = packing.cell.tilt_moves[t] ? std::max(out.tilt, off) : out.tilt;
        }
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const double in_plane = std::hypot(left[d * i], left[d * i + 1]);
            out.disk.push_back(d == 2 ? in_plane : std::hypot(in_plane, left[d * i + 2]));
            out.disks = std::max(out.disks, out.disk.back());
        }
        return out;
    }

    /// Bound of the residual from rounding in forces that are not in the files, on the grain where it is largest.
    [[nodiscard]] double blurred_by_law() const {
        std::map<int, double> at; // disks, and walls from -1 down
        double most = 0;
        for (const auto& [c, force] : force_) {
            if (beyond_.count(c) == 0) {
                const int other = is_wall(c) ? -1 - static_cast<int>(c.wall_number()) : c.j;
                for (const int grain : {c.i, other}) {
                    most = std::max(most, at[grain] += unknown(c));
                }
            }
        }
        return most;
    }

    /// A moving wall drags disks along. When all disks balance and the wall does not, the load belongs to another
    /// frame, or the wall drifts slowly along a mechanism.
    void check_load(const Left& left, double blur) {
        for (std::size_t axis = 0; axis < frame_.packing.axes(); ++axis) {
            if (left.walls[axis] > series_.rest * out_.mean + blur && left.disks < wall_alone * left.walls[axis]) {
                const std::string wall = frame_.packing.cell.any() ? fmt::format("period along {}", axis_names[axis])
                                                                   : fmt::format("{} wall", upper_wall_names[axis]);
                out_.other_load = fmt::format("{}: the forces on the {} and its load differ by {:.6g}, those on every "
                                              "{} balance to {:.2g} (the load of another frame?)",
                                              frame_.row, wall, left.walls[axis], grain(), left.disks);
                return;
            }
        }
    }

    /// A moving disk drags its neighbours along too.
    void check_disks(const Left& left) {
        std::string names;
        int off = 0;
        double others = 0;
        for (std::size_t i = 0; i < left.disk.size(); ++i) {
            if (left.disk[i] < disk_alone * left.disks) {
                others = std::max(others, left.disk[i]);
            } else if (++off <= 2) {
                names += fmt::format("{}{}", off > 1 ? " and " : "", frame_.ids[i]);
            }
        }
        if (off <= 2 && left.disks > series_.rest * out_.mean) {
            out_.few = fmt::format("; all {}s but {} balance to {:.2g}: is a contact of theirs missing, or its force "
                                   "wrong?",
                                   grain(), names, others);
        }
    }

    void balance() {
        const bool law = series_.law != ForceLaw::none;
        if (law || (series_.listed && walls_listed_)) {
            const Left left = left_by(force_);
            const double blur = blurred_by_law();
            check_load(left, blur);
            if (!law) {
                check_disks(left);
            }
            left_ = left.largest();
            out_.result.unbalanced = out_.mean > 0 ? left_ / out_.mean : HUGE_VAL;
            noise_ = out_.other_load.empty() ? left_ : left.disks;
            out_.blurred = left_ <= blur;
        }
        std::map<Contact, double> forces;
        for (const Contact& c : overlaps_) {
            forces.emplace(c, expected(c));
        }
        left_by_law_ = law ? left_by(forces).largest() : 0;
    }

    void make_list() {
        std::vector<Contact> strong;
        for (const auto& [c, force] : force_) {
            if (force > noise_ || force == 0) {
                strong.push_back(c);
            }
            if (force > 0) {
                out_.pressed.push_back(c);
            }
        }
        out_.contacts = able_to_carry(frame_.packing, std::move(strong));
        for (const Contact& c : out_.contacts) {
            out_.forces.push_back(force_.at(c));
        }
    }

    const Series& series_;
    const Frame& frame_;
    ContactLaw law_;
    Reading out_;
    bool walls_listed_ = false;         ///< otherwise the contacts of walls are the overlaps
    double rounding_ = 0;               ///< error of an overlap, as a length
    double left_ = 0, left_by_law_ = 0; ///< largest residual force, by the files and by the overlaps
    double noise_ = 0;                  ///< smaller forces count as zero
    std::vector<Contact> overlaps_;
    std::map<Contact, double> force_;
    std::map<Contact, double> beyond_; ///< for each contact of the files, the force less that of the law
    std::map<Contact, std::string> row_;
};

} // namespace

Reading read_frame(const Series& series, const Frame& frame) {
    return Reader(series, frame).run();
}

} // namespace isostat::compare

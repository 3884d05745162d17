// Reads the frames of a series, matched by time step.
#include "compare/manifest.hpp"
#include "io/files.hpp"
#include "io/numbers.hpp"
#include "packing/words.hpp"
#include "snap/frame_file.hpp"
#include "snap/soft_list.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>

namespace isostat::compare {

namespace {

using foreign::Boundary;
using foreign::FrameHeader;

/// The wall that a field of a file of contacts names: by its name, or -1
/// left, -2 bottom, -3 right, -4 top; for spheres also -5 back, -6 front.
std::optional<std::size_t> wall_of(std::string_view field, const Manifest& manifest) {
    const std::vector<std::string> names = manifest.wall_names();
    const std::size_t d = manifest.axes();
    for (std::size_t w = 0; w < names.size(); ++w) {
        const std::size_t axis = w % d, upper = w / d;
        const std::size_t number = axis < 2 ? 1 + axis + 2 * upper : 5 + upper;
        if (field == names[w] || field == fmt::format("-{}", number)) {
            return w;
        }
    }
    return std::nullopt;
}

/// Positions of the walls of a frame, or of the sides of its cell.
struct Sides {
    bool stated = false; ///< otherwise the file of disks states them
    PerAxis<double> low{}, high{};
    PerTilt<double> tilt{}; ///< of a cell
    Digits digits;
    [[nodiscard]] double length(std::size_t axis) const { return high[axis] - low[axis]; }
};

/// Reads the table of frames.
class FrameTable {
  public:
    explicit FrameTable(const Manifest& manifest)
        : manifest_(manifest), text_(read_text(manifest.frames)), lines_(text_, manifest.frames) {
        const TextLine names = lines_.next("names of columns", ',');
        names_.assign(names.fields().begin(), names.fields().end());
        where_ = names.place();
        foreign::refuse_twice(names_, where_);
        (void)required("timestep");
        sides_ = !manifest.periodic; // the bounds of a dump are not the walls
        for (std::size_t t = 0; t < tilts(); ++t) {
            sides_ = sides_ || find(tilt_column(t)) >= 0;
        }
        const std::vector<std::string> walls = manifest.wall_names();
        for (const std::string& name : walls) {
            sides_ = sides_ || find(name) >= 0;
        }
        for (const std::string& name : walls) {
            if (sides_) {
                (void)required(name);
            }
        }
        for (std::size_t axis = 0; manifest.series.several && axis < last(); ++axis) {
            if (find(stress_column(axis)) < 0) {
                refuse(where_, "no column '{}': expected it, or {} in [load] of the manifest", stress_column(axis),
                       stress_column(axis));
            }
        }
        if (find(stress_column(last())) < 0 &&
            (manifest.load == LoadKind::true_stress || find(force_column(last())) < 0)) {
            refuse(where_,
                   "no column '{}'{}: expected it (series under stated stresses are compared, not those under stated "
                   "strains)",
                   stress_column(last()),
                   manifest.load == LoadKind::nominal ? " nor '" + force_column(last()) + "'" : "");
        }
    }

    /// The next frame without its disks, with sides and load; empty at the end.
    std::optional<Frame> next(Sides& sides) {
        if (lines_.only_blanks()) {
            return std::nullopt;
        }
        const TextLine line = lines_.next("a frame", ',');
        line.require_size(names_.size(), "one value per column");
        Frame frame;
        frame.number = count_++;
        frame.row = fmt::format("{}:{}", manifest_.frames, line.number());
        const std::size_t step = required("timestep");
        frame.timestep = line.integer(step, "timestep", 0, 1L << 62);
        if (frame.timestep <= last_) {
            line.fail(line.field(step), "timestep", "a number above {}, that of the frame before", last_);
        }
        last_ = frame.timestep;
        if (sides_) {
            sides = sides_of(line);
        }
        frame.load = load_of(line);
        frame.scale = manifest_.series.several ? frame.load.stress[0] : 1;
        return frame;
    }

  private:
    [[nodiscard]] int find(const std::string& name) const { return foreign::find_column(names_, name); }
    /// The axis whose stress is in the frames.
    [[nodiscard]] std::size_t last() const { return manifest_.axes() - 1; }
    [[nodiscard]] std::size_t tilts() const { return Layout{manifest_.series.dimension}.tilts(); }
    [[nodiscard]] static std::string stress_column(std::size_t axis) { return fmt::format("sigma{}", axis + 1); }
    [[nodiscard]] std::string force_column(std::size_t axis) const {
        return "force_" + manifest_.wall_names()[manifest_.axes() + axis];
    }
    [[nodiscard]] std::string tilt_column(std::size_t tilt) const {
        return manifest_.series.dimension == plane ? "tilt" : fmt::format("tilt_{}", tilt_names[tilt]);
    }
    [[nodiscard]] std::size_t required(const std::string& name) const {
        const int at = find(name);
        if (at < 0) {
            refuse(where_,
                   "no column '{}': expected timestep, the positions of the walls {} (the bounds of a dump are not "
                   "taken for them), and {} or {}",
                   name, fmt::join(manifest_.wall_names(), ", "), stress_column(last()), force_column(last()));
        }
        return static_cast<std::size_t>(at);
    }

    [[nodiscard]] Sides sides_of(const TextLine& line) const {
        Sides sides;
        sides.stated = true;
        const std::vector<std::string> walls = manifest_.wall_names();
        const auto read = [&](std::size_t column, const std::string& name) {
            sides.digits.see(line.field(column));
            return line.number(column, name) * manifest_.length_factor;
        };
        for (std::size_t w = 0; w < walls.size(); ++w) {
            PerAxis<double>& side = w < manifest_.axes() ? sides.low : sides.high;
            side[w % manifest_.axes()] = read(required(walls[w]), walls[w]);
        }
        for (std::size_t t = 0; t < tilts() && manifest_.periodic; ++t) {
            if (const int tilt = find(tilt_column(t)); tilt >= 0) {
                sides.tilt[t] = read(static_cast<std::size_t>(tilt), tilt_column(t));
            }
        }
        return sides;
    }

    [[nodiscard]] Load load_of(const TextLine& line) {
        Load load;
        load.kind = manifest_.load;
        load.dimension = manifest_.series.dimension;
        load.loaded_axis = load.dimension - 1;
        load.reference_length = manifest_.reference_length;
        load.stress = manifest_.series.several ? lateral_of(line) : manifest_.stress;
        const std::string name = stress_column(last()), force = force_column(last());
        double& loaded = load.stress[last()];
        if (const int at = find(name); at >= 0) {
            loaded = line.number(static_cast<std::size_t>(at), name);
        } else {
            const double per_force = manifest_.force_factor / manifest_.reference_area(last());
            loaded = line.number(required(force), force) * per_force;
        }
        if (!(loaded > 0 && std::isfinite(loaded))) {
            line.fail(fmt::format("{}", loaded), name, "a positive number");
        }
        for (std::size_t axis = 0; axis < manifest_.axes(); ++axis) {
            check_stress(line, axis, load);
            check_force(line, axis, load);
        }
        return load;
    }

    /// The stresses of all axes but the last, in the proportion of the first frame.
    [[nodiscard]] PerAxis<double> lateral_of(const TextLine& line) {
        PerAxis<double> out{};
        for (std::size_t axis = 0; axis < last(); ++axis) {
            const std::string name = stress_column(axis);
            const auto column = static_cast<std::size_t>(find(name));
            out[axis] = line.number(column, name);
            if (!(out[axis] > 0 && std::isfinite(out[axis]))) {
                line.fail(line.field(column), name, "a positive number");
            }
        }
        proportion_ = count_ == 1 ? out : proportion_;
        for (std::size_t axis = 1; axis < last(); ++axis) {
            out[axis] = out[0] * (proportion_[axis] / proportion_[0]); // `check_stress` compares it with the row
        }
        return out;
    }

    /// Checks that stresses constant over the frames are those of the manifest, to the digits of a file.
    void check_stress(const TextLine& line, std::size_t axis, const Load& load) const {
        const std::string name = stress_column(axis);
        const int at = find(name);
        if (at < 0 || axis == last()) {
            return;
        }
        const auto column = static_cast<std::size_t>(at);
        const double expected = load.stress[axis];
        if (!(std::abs(line.number(column, name) - expected) <= known * expected + rounding(line, column))) {
            line.fail(line.field(column), name,
                      manifest_.series.several
                          ? fmt::format("{}, in the proportion to sigma1 that the first frame has: series in which it "
                                        "changes are not compared",
                                        expected)
                          : fmt::format("{}, the one of the manifest: without sigma1 there each frame has its own",
                                        expected));
        }
    }

    /// Checks that a force on a wall is that of the load, to the digits of a file.
    void check_force(const TextLine& line, std::size_t axis, const Load& load) const {
        const std::string name = force_column(axis);
        const int at = find(name);
        if (at < 0 || load.kind == LoadKind::true_stress) {
            return;
        }
        const auto column = static_cast<std::size_t>(at);
        const double area = manifest_.reference_area(axis), expected = load.stress[axis] * area;
        double digits = rounding(line, column) * manifest_.force_factor;
        if (const int stress = find(stress_column(axis)); stress >= 0 && axis == last()) {
            digits += rounding(line, static_cast<std::size_t>(stress)) * area;
        }
        if (!(std::abs(line.number(column, name) * manifest_.force_factor - expected) <= known * expected + digits)) {
            line.fail(line.field(column), fmt::format("{} (column {})", name, at + 1),
                      "{}, the stress {} times the reference {} {}", expected / manifest_.force_factor,
                      load.stress[axis], load.dimension == plane ? "length" : "area", area);
        }
    }

    [[nodiscard]] static double rounding(const TextLine& line, std::size_t column) {
        Digits digits;
        digits.see(line.field(column));
        return digits.rounding();
    }

    static constexpr double known = 1e-9; ///< tolerance of a force or a stress that is stated twice
    const Manifest& manifest_;
    std::string text_;
    TextLines lines_;
    std::vector<std::string> names_;
    std::string where_;
    bool sides_ = true; ///< the table states them
    PerAxis<double> proportion_{};
    int count_ = 0;
    long last_ = -1; ///< time step
};

/// Reads the disks of the frames, which are those of the first frame, by id.
class Disks {
  public:
    explicit Disks(const Manifest& manifest) : manifest_(manifest), dump_(manifest.disks, "ATOMS") {}

    void read(Frame& frame, Sides sides) {
        begin(frame.packing);
        const FileFrame rows = dump_.at(frame.timestep);
        check_boundaries(rows, sides);
        const std::size_t id = dump_.column(rows, "id"), size = dump_.column(rows, manifest_.size);
        const std::vector<std::size_t> centre = columns_of(rows, {"x", "y", "z"}), speeds = speeds_of(rows);
        const std::map<long, const TextLine*> by_id = selected(rows, id);
        require_a_plane(rows, by_id, size);
        const double f = manifest_.length_factor;
        if (manifest_.periodic && !sides.stated) {
            sides = sides_of(rows.header);
        }
        if (!last_.radius.empty() && manifest_.periodic) {
            unflip(frame, sides);
        }
        Digits places, sizes;
        for (const auto& [number, row] : by_id) {
            const auto disk = frame.ids.size();
            if (frame.number > 0 && (disk >= ids_.size() || number != ids_[disk])) {
                row->fail(row->field(id), "id",
                          "the ids of the first frame" +
                              (disk < ids_.size() ? fmt::format(", {} next", ids_[disk]) : std::string()));
            }
            frame.ids.push_back(number);
            frame.packing.radius.push_back(row->number(size, manifest_.size) * f * (manifest_.diameters ? 0.5 : 1));
            if (!(frame.packing.radius.back() > 0)) {
                row->fail(row->field(size), manifest_.size, "a positive number");
            }
            if (disk < first_.radius.size() && frame.packing.radius[disk] != first_.radius[disk]) {
                row->fail(row->field(size), manifest_.size, "the one that this {} has in the first frame", grain());
            }
            sizes.see(row->field(size));
            for (std::size_t a = 0; a < centre.size(); ++a) {
                frame.packing.q.push_back(row->number(centre[a], axis_names[a]) * f - sides.low[a]);
                places.see(row->field(centre[a]));
            }
            for (const std::size_t column : speeds) {
                frame.velocity.push_back(finite_number(row->field(column)).value_or(NAN) * f);
            }
            add_walls(frame, *row, rows, static_cast<int>(disk));
        }
        for (std::size_t a = 0; a < manifest_.axes(); ++a) {
            frame.packing.q.push_back(sides.length(a));
        }
        if (manifest_.periodic) {
            std::copy_n(sides.tilt.begin(), frame.packing.tilts(), std::back_inserter(frame.packing.q));
        }
        check_all(frame, dump_.where(rows.header.line));
        frame.rounding = f * rounding_of_gaps(places.rounding(), sides.digits.rounding(),
                                              sizes.rounding() * (manifest_.diameters ? 0.5 : 1),
                                              {frame.packing.dimension, sides.tilt != PerTilt<double>{}});
        keep(frame);
    }

    void begin_after(const Packing& packing) {
        if (packing.cell.all()) {
            last_ = packing;
        }
    }

  private:
    [[nodiscard]] const char* grain() const { return grain_word(manifest_.series.dimension); }
    /// The columns of the components of a vector.
    [[nodiscard]] std::vector<std::size_t> columns_of(const FileFrame& rows, const PerAxis<const char*>& names) const {
        std::vector<std::size_t> out;
        for (std::size_t a = 0; a < manifest_.axes(); ++a) {
            out.push_back(dump_.column(rows, names[a]));
        }
        return out;
    }
    /// The rows of the disks, by the number in column `id`.
    [[nodiscard]] std::map<long, const TextLine*> selected(const FileFrame& rows, std::size_t id) const {
        std::map<long, const TextLine*> by_id;
        for (const TextLine& row : rows.rows) {
            if (manifest_.select_column.empty() ||
                row.field(dump_.column(rows, manifest_.select_column)) == manifest_.select_value) {
                if (!by_id.emplace(row.integer(id, "id", 0, 1L << 62), &row).second) {
                    row.fail(row.field(id), "id", "every {} once", grain());
                }
            }
        }
        if (by_id.empty()) {
            refuse(dump_.where(rows.header.line), "no {}s are selected: expected at least one", grain());
        }
        return by_id;
    }
    /// Checks for disks that z is constant, or varies by so little that no gap is another double.
    void require_a_plane(const FileFrame& rows, const std::map<long, const TextLine*>& by_id, std::size_t size) const {
        const int z = foreign::find_column(rows.header.names, "z");
        for (const auto& [number, row] : by_id) {
            if (z < 0 || manifest_.series.dimension != plane) {
                return;
            }
            const auto at = static_cast<std::size_t>(z);
            const double first = by_id.begin()->second->number(at, "z");
            if (!(std::abs(row->number(at, "z") - first) <= 0x1p-28 * row->number(size, manifest_.size))) {
                row->fail(row->field(at), "z",
                          "{}, as of the first disk (three lengths in reference_length make a series of spheres)",
                          first);
            }
        }
    }
    /// Checks that all grains of the first frame are present, and that all have velocities or none has.
    void check_all(Frame& frame, const std::string& place) const {
        if (frame.ids.size() < ids_.size()) {
            refuse(ErrorKind::bad_input, "{0}: no {1} {2}: expected the {1}s of the first frame", place, grain(),
                   ids_[frame.ids.size()]);
        }
        if (std::ranges::any_of(frame.velocity, [](double v) { return std::isnan(v); })) {
            frame.velocity.clear();
        }
        validate(frame.packing, place);
    }
    /// Keeps the frame for comparisons with the next one.
    void keep(Frame& frame) {
        if (frame.number == 0) {
            ids_ = frame.ids;
            first_ = frame.packing;
        }
        if (manifest_.periodic && last_.radius.size() == frame.packing.radius.size()) {
            unwrap(frame.packing);
        }
        last_ = frame.packing;
    }
    /// The columns vx, vy (and vz); empty when the file has none.
    [[nodiscard]] std::vector<std::size_t> speeds_of(const FileFrame& rows) const {
        constexpr PerAxis<const char*> speeds{"vx", "vy", "vz"};
        const bool all =
            std::all_of(speeds.begin(), speeds.begin() + manifest_.series.dimension,
                        [&](const char* name) { return foreign::find_column(rows.header.names, name) >= 0; });
        return all ? columns_of(rows, speeds) : std::vector<std::size_t>();
    }
    /// Sets the dimension, and walls or a cell.
    void begin(Packing& packing) const {
        packing.dimension = packing.cell.dimension = manifest_.series.dimension;
        packing.walls = manifest_.periodic ? Walls::none() : Walls::box(packing.dimension);
        if (manifest_.periodic) {
            packing.cell.repeat();
            packing.cell.move(true, manifest_.tilted);
        }
    }
    /// The bounds of a dump as the cell.
    [[nodiscard]] Sides sides_of(const FrameHeader& header) const {
        Sides sides;
        for (std::size_t a = 0; a < manifest_.axes(); ++a) {
            sides.low[a] = header.box.value()[a][0] * manifest_.length_factor;
            sides.high[a] = header.box.value()[a][1] * manifest_.length_factor;
            sides.digits.see(header.sides[a]);
        }
        for (std::size_t t = 0; t < Layout{manifest_.series.dimension}.tilts(); ++t) {
            sides.tilt[t] = header.tilt[t] * manifest_.length_factor;
        }
        return sides;
    }

    /// Checks that the file has walls, or all axes periodic, as the manifest states, and that the cell is stated once.
    void check_boundaries(const FileFrame& rows, const Sides& sides) const {
        const FrameHeader& header = rows.header;
        if (header.leaves_the_plane() && manifest_.series.dimension == plane) {
            refuse(header.place, "expected a cell in the plane of the disks");
        }
        if (header.vectors && !foreign::are_upper(*header.vectors, manifest_.axes())) {
            refuse(dump_.where(header.line),
                   "Lattice: expected the first vector along x and the second in the plane of x and y, in a series");
        }
        const std::string walls = fmt::format("{}", fmt::join(manifest_.wall_names(), ", "));
        if (manifest_.periodic && sides.stated && header.box) {
            refuse(dump_.where(header.line), "bounds of the cell here, and columns {} in {}: expected one of them",
                   walls, manifest_.frames);
        }
        for (std::size_t axis = 0; axis < manifest_.axes(); ++axis) {
            const Boundary boundary = header.boundary[axis];
            const bool periodic = boundary == Boundary::periodic || (sides.stated && boundary == Boundary::unknown);
            if (manifest_.periodic ? !periodic || !(sides.stated || header.box) : boundary == Boundary::periodic) {
                refuse(dump_.where(header.line), "the box is {}periodic along {}: expected {}",
                       manifest_.periodic ? "not " : "", axis_names[axis],
                       manifest_.periodic
                           ? fmt::format("periodic boundaries with bounds (a dump with pp, XYZ with Lattice, columns "
                                         "{} of the frames), the manifest has a [cell]",
                                         walls)
                           : "walls, or a [cell] in the manifest (in XYZ pbc=\"F F F\" says that there are walls)");
            }
        }
    }

    /// Other programs flip a strongly sheared box by whole periods: each tilt is moved next to the tilt of the previous
    /// frame. The periods along z are turned back first, because those along y change their tilt along x.
    void unflip(Frame& frame, Sides& sides) {
        const Cell& cell = frame.packing.cell;
        const PerTilt<double> in_file = sides.tilt;
        PerTilt<double> periods{};
        for (const std::size_t tilt : {Cell::tilt(1, 2), Cell::tilt(0, 1), Cell::tilt(0, 2)}) {
            if (tilt >= frame.packing.tilts()) {
                continue;
            }
            const auto [along, of] = cell.axes_of_tilt(tilt);
            const auto a = static_cast<std::size_t>(along), b = static_cast<std::size_t>(of);
            periods[tilt] = std::round((last_.lattice(a, b) - sides.tilt[tilt]) / sides.length(a));
            sides.tilt[tilt] += periods[tilt] * sides.length(a);
            if (a == 1) {
                sides.tilt[Cell::tilt(0, 2)] += periods[tilt] * sides.tilt[Cell::tilt(0, 1)];
            }
        }
        for (std::size_t t = 0; t < frame.packing.tilts(); ++t) {
            const double flips = std::abs(periods[t] - flipped_[t]);
            if (flips != 0) {
                frame.note += fmt::format(
                    "{}box flipped by {} along {}: the tilt {} of the file is {} here, the same "
                    "lattice",
                    frame.note.empty() ? "" : "; ", flips == 1 ? "one period" : fmt::format("{} periods", flips),
                    axis_names[static_cast<std::size_t>(cell.axes_of_tilt(t)[0])], in_file[t], sides.tilt[t]);
            }
        }
        flipped_ = periods;
    }

    /// Other programs wrap grains that leave the cell. Each grain is put where its motion since the previous frame,
    /// relative to the first grain, is smallest, so that contacts keep their images.
    void unwrap(Packing& packing) const {
        const std::size_t d = packing.axes();
        const auto fractions = [d](const Packing& p, std::size_t i) {
            PerAxis<double> out{};
            for (std::size_t a = d; a-- > 0;) {
                double way = p.q[d * i + a] - p.q[a];
                for (std::size_t b = d - 1; b > a; --b) {
                    way -= out[b] * p.lattice(a, b);
                }
                out[a] = way / p.length(static_cast<int>(a));
            }
            return out;
        };
        for (std::size_t i = 1; i < packing.radius.size(); ++i) {
            const PerAxis<double> now = fractions(packing, i), before = fractions(last_, i);
            for (std::size_t a = 0; a < d; ++a) {
                double way = 0;
                for (std::size_t b = a; b < d; ++b) {
                    way += std::round(before[b] - now[b]) * packing.lattice(a, b);
                }
                packing.q[d * i + a] += way;
            }
        }
    }

    /// Adds the wall forces that are not 0, positive when they press the disk inwards.
    void add_walls(Frame& frame, const TextLine& row, const FileFrame& rows, int disk) {
        if (!manifest_.series.wall_forces) {
            return;
        }
        for (std::size_t w = 0; w < manifest_.wall_force.size(); ++w) {
            const std::string& name = manifest_.wall_force[w];
            const double force = row.number(dump_.column(rows, name), name) * manifest_.force_factor;
            if (force != 0) {
                frame.contacts.push_back(
                    {manifest_.with_wall(disk, w), w < manifest_.axes() ? force : -force, dump_.where(row.number())});
            }
        }
    }

    const Manifest& manifest_;
    FrameFile dump_;
    std::vector<long> ids_;
    Packing first_, last_;
    PerTilt<double> flipped_{}; ///< number of periods between the tilts of the file and those of the frames
};

/// Reads the rows of the file of contacts. A contact that occurs twice is kept twice, and `compare` names it.
void read_contacts(const Manifest& manifest, FrameFile& dump, Frame& frame) {
    const FileFrame rows = dump.at(frame.timestep);
    const std::size_t first = dump.column(rows, manifest.contact_i), second = dump.column(rows, manifest.contact_j);
    std::vector<std::size_t> columns;
    for (const std::string& name : manifest.contact_force) {
        columns.push_back(dump.column(rows, name));
    }
    const std::string grain = fmt::format("the id of a {}", grain_word(manifest.series.dimension));
    const std::string expected =
        manifest.periodic ? grain : fmt::format("{}, or {}", grain, fmt::join(manifest.wall_names(), ", "));
    const auto disk = [&](const TextLine& row, std::size_t at, const std::string& name) {
        if (row.field(at).find_first_not_of("0123456789") != std::string_view::npos) {
            row.fail(row.field(at), name, expected);
        }
        const long id = row.integer(at, name, 0, 1L << 62);
        const auto found = std::ranges::lower_bound(frame.ids, id);
        if (found == frame.ids.end() || *found != id) {
            row.fail(row.field(at), name, expected);
        }
        return static_cast<int>(found - frame.ids.begin());
    };
    PairImages images(frame.packing);
    const std::size_t walls = frame.contacts.size(); // those from columns of the disks
    std::vector<VectorForce> vectors;
    for (const TextLine& row : rows.rows) {
        FileContact contact;
        double sign = 1; // factor of a vector
        const auto one = wall_of(row.field(first), manifest), other = wall_of(row.field(second), manifest);
        if (one.has_value() != other.has_value() && !manifest.periodic) {
            contact.contact = one ? manifest.with_wall(disk(row, second, manifest.contact_j), *one)
                                  : manifest.with_wall(disk(row, first, manifest.contact_i), *other);
            sign = one ? -1 : 1;
        } else {
            const int i = disk(row, first, manifest.contact_i), j = disk(row, second, manifest.contact_j);
            if (i == j) {
                row.fail(row.field(second), manifest.contact_j, "another {} than the first",
                         grain_word(manifest.series.dimension));
            }
            contact.contact = images.next(i, j);
            sign = i < j ? 1 : -1;
        }
        contact.force = row.number(columns[0], manifest.contact_force[0]) * manifest.force_factor;
        vectors.push_back({contact.contact, {}});
        for (std::size_t a = 0; a < columns.size() && columns.size() > 1; ++a) {
            vectors.back().force[a] = sign * row.number(columns[a], manifest.contact_force[a]) * manifest.force_factor;
        }
        contact.row = dump.where(row.number());
        frame.contacts.push_back(std::move(contact));
    }
    if (columns.size() > 1) {
        std::string words;
        const std::vector<double> parts = normal_parts(frame.packing, vectors, dump.where(rows.header.line), words);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            frame.contacts[k + walls].force = parts[k];
        }
    }
}

} // namespace

struct SeriesReader::Files {
    explicit Files(const std::filesystem::path& path)
        : manifest(read_manifest(path)), table(manifest), disks(manifest) {
        if (manifest.series.listed) {
            contacts = std::make_unique<FrameFile>(manifest.contacts, "ENTRIES");
        }
    }
    Manifest manifest;
    FrameTable table;
    Disks disks;
    std::unique_ptr<FrameFile> contacts;
    bool any = false;
};

SeriesReader::SeriesReader(const std::filesystem::path& manifest) : files_(std::make_unique<Files>(manifest)) {}
SeriesReader::~SeriesReader() = default;

const Series& SeriesReader::series() const {
    return files_->manifest.series;
}

void SeriesReader::begin_after(const Packing& packing) {
    files_->disks.begin_after(packing);
}

std::optional<Frame> SeriesReader::next() {
    Sides sides;
    auto frame = files_->table.next(sides);
    if (!frame) {
        if (!files_->any) {
            refuse(files_->manifest.frames, "no frames: expected at least one row");
        }
        return std::nullopt;
    }
    files_->any = true;
    files_->disks.read(*frame, sides);
    if (files_->contacts) {
        read_contacts(files_->manifest, *files_->contacts, *frame);
    }
    return frame;
}

} // namespace isostat::compare

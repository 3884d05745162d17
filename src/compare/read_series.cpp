// Frames of a series, matched by time step.
#include "compare/frame_file.hpp"
#include "compare/manifest.hpp"
#include "compare/pair_images.hpp"
#include "io/digits.hpp"
#include "io/files.hpp"
#include "io/numbers.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace isostat::compare {

namespace {

using foreign::Boundary;
using foreign::FrameHeader;

/// Which wall a field of a file of contacts means: its name, or -1 left, -2 bottom, -3 right, -4 top.
std::optional<std::size_t> wall_of(std::string_view field) {
    for (std::size_t w = 0; w < wall_names.size(); ++w) {
        if (field == wall_names[w] || field == fmt::format("-{}", w + 1)) {
            return w;
        }
    }
    return std::nullopt;
}

/// Where the walls of a frame are, or the sides of its cell; none: the file of disks says so.
struct Sides {
    std::optional<std::array<double, 4>> at; ///< left, bottom, right, top
    double tilt = 0;                         ///< of a cell: the way along x from its lower to its upper side
    Digits digits;
};

/// The table of frames.
class FrameTable {
  public:
    explicit FrameTable(const Manifest& manifest)
        : manifest_(manifest), text_(read_text(manifest.frames)), lines_(text_, manifest.frames) {
        const TextLine names = lines_.next("names of columns", ',');
        for (std::size_t k = 0; k < names.size(); ++k) {
            names_.emplace_back(names.field(k));
        }
        where_ = names.place();
        foreign::refuse_twice(names_, where_);
        (void)required("timestep");
        sides_ = !manifest.periodic || find("tilt") >= 0; // the bounds of a dump are not the walls
        for (const char* name : wall_names) {
            sides_ = sides_ || find(name) >= 0;
        }
        for (const char* name : wall_names) {
            if (sides_) {
                (void)required(name);
            }
        }
        if (find("sigma2") < 0 && (manifest.load == LoadKind::true_stress || find("force_top") < 0)) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: no column 'sigma2'{}: expected it", where_,
                                    manifest.load == LoadKind::nominal ? " nor 'force_top'" : ""));
        }
    }

    /// The next frame without its disks: sides and load. Nothing at the end.
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
            line.fail(line.field(step), "timestep", fmt::format("a number above {}, that of the frame before", last_));
        }
        last_ = frame.timestep;
        if (sides_) {
            sides = sides_of(line);
        }
        frame.load = load_of(line);
        return frame;
    }

  private:
    [[nodiscard]] int find(const std::string& name) const { return foreign::find_column(names_, name); }
    [[nodiscard]] std::size_t required(const std::string& name) const {
        const int at = find(name);
        if (at < 0) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: no column '{}': expected timestep, the positions of the walls left, bottom, "
                                    "right, top (the bounds of a dump are not taken for them), and sigma2 or force_top",
                                    where_, name));
        }
        return static_cast<std::size_t>(at);
    }

    [[nodiscard]] Sides sides_of(const TextLine& line) const {
        Sides sides{std::array<double, 4>{}, 0, {}};
        for (std::size_t w = 0; w < 4; ++w) {
            const std::size_t column = required(wall_names[w]);
            (*sides.at)[w] = line.number(column, wall_names[w]) * manifest_.length_factor;
            sides.digits.see(line.field(column));
        }
        if (const int tilt = find("tilt"); tilt >= 0 && manifest_.periodic) {
            sides.tilt = line.number(static_cast<std::size_t>(tilt), "tilt") * manifest_.length_factor;
            sides.digits.see(line.field(static_cast<std::size_t>(tilt)));
        }
        return sides;
    }

    [[nodiscard]] Load load_of(const TextLine& line) const {
        Load load;
        load.kind = manifest_.load;
        std::copy(manifest_.reference_length.begin(), manifest_.reference_length.end(), load.reference_length.begin());
        load.stress = {manifest_.sigma1, 0};
        const double per_force = manifest_.force_factor / manifest_.reference_length[0];
        if (const int at = find("sigma2"); at >= 0) {
            load.stress[1] = line.number(static_cast<std::size_t>(at), "sigma2");
        } else {
            load.stress[1] = line.number(required("force_top"), "force_top") * per_force;
        }
        if (!(load.stress[1] > 0 && std::isfinite(load.stress[1]))) {
            line.fail(fmt::format("{}", load.stress[1]), "sigma2", "a positive number");
        }
        for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
            check_force(line, axis, load);
        }
        return load;
    }

    /// A force on a wall must be that of the load, to the digits that a file has.
    void check_force(const TextLine& line, std::size_t axis, const Load& load) const {
        constexpr double known = 1e-9;
        const std::string name = axis == 0 ? "force_right" : "force_top";
        const int at = find(name);
        if (at < 0 || load.kind == LoadKind::true_stress) {
            return;
        }
        const auto column = static_cast<std::size_t>(at);
        const double expected = load.stress[axis] * load.reference_length[1 - axis];
        double digits = rounding(line, column) * manifest_.force_factor;
        if (const int stress = find("sigma2"); stress >= 0 && axis == 1) {
            digits += rounding(line, static_cast<std::size_t>(stress)) * load.reference_length[0];
        }
        if (!(std::abs(line.number(column, name) * manifest_.force_factor - expected) <= known * expected + digits)) {
            line.fail(line.field(column), fmt::format("{} (column {})", name, at + 1),
                      fmt::format("{}, the stress {} times the reference length {}", expected / manifest_.force_factor,
                                  load.stress[axis], load.reference_length[1 - axis]));
        }
    }

    [[nodiscard]] static double rounding(const TextLine& line, std::size_t column) {
        Digits digits;
        digits.see(line.field(column));
        return digits.rounding();
    }

    const Manifest& manifest_;
    std::string text_;
    TextLines lines_;
    std::vector<std::string> names_;
    std::string where_;
    bool sides_ = true; ///< it has them
    int count_ = 0;
    long last_ = -1; ///< time step
};

/// Disks of the frames: those of the first one, by id.
class Disks {
  public:
    explicit Disks(const Manifest& manifest) : manifest_(manifest), dump_(manifest.disks, "ATOMS") {}

    void read(Frame& frame, Sides sides) {
        const FileFrame rows = dump_.at(frame.timestep);
        check_boundaries(rows, sides);
        const std::size_t id = dump_.column(rows, "id"), size = dump_.column(rows, manifest_.size);
        const std::size_t x = dump_.column(rows, "x"), y = dump_.column(rows, "y");
        const std::map<long, const TextLine*> by_id = selected(rows, id);
        const double f = manifest_.length_factor;
        if (manifest_.periodic) {
            make_periodic(frame.packing);
            sides = sides.at ? sides : sides_of(rows.header);
        }
        const std::array<double, 4> walls = sides.at.value();
        if (!last_.radius.empty() && manifest_.periodic) {
            sides.tilt = unflipped(frame, sides.tilt, walls[2] - walls[0]);
        }
        const std::vector<std::size_t> speeds = speeds_of(rows);
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
                row->fail(row->field(size), manifest_.size, "the one that this disk has in the first frame");
            }
            frame.packing.q.push_back(row->number(x, "x") * f - walls[0]);
            frame.packing.q.push_back(row->number(y, "y") * f - walls[1]);
            sizes.see(row->field(size));
            for (const std::size_t column : {x, y}) {
                places.see(row->field(column));
            }
            for (const std::size_t column : speeds) {
                frame.velocity.push_back(finite_number(row->field(column)).value_or(NAN) * f);
            }
            add_walls(frame, *row, rows, static_cast<int>(disk));
        }
        frame.packing.q.insert(frame.packing.q.end(), {walls[2] - walls[0], walls[3] - walls[1]});
        if (manifest_.periodic) {
            frame.packing.q.push_back(sides.tilt);
        }
        if (frame.ids.size() < ids_.size()) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: no disk {}: expected the disks of the first frame",
                                                          dump_.where(rows.header.line), ids_[frame.ids.size()]));
        }
        if (std::any_of(frame.velocity.begin(), frame.velocity.end(), [](double v) { return std::isnan(v); })) {
            frame.velocity.clear();
        }
        validate(frame.packing, dump_.where(rows.header.line));
        require_plane(frame.packing, dump_.where(rows.header.line), "compare");
        frame.rounding = f * rounding_of_gaps(places.rounding(), sides.digits.rounding(),
                                              sizes.rounding() * (manifest_.diameters ? 0.5 : 1),
                                              {2, manifest_.periodic && sides.tilt != 0});
        keep(frame);
    }

    void begin_after(const Packing& packing) {
        if (packing.cell.all()) {
            last_ = packing;
        }
    }

  private:
    /// The rows of the disks, by the number in column `id`.
    [[nodiscard]] std::map<long, const TextLine*> selected(const FileFrame& rows, std::size_t id) const {
        std::map<long, const TextLine*> by_id;
        for (const TextLine& row : rows.rows) {
            if (manifest_.select_column.empty() ||
                row.field(dump_.column(rows, manifest_.select_column)) == manifest_.select_value) {
                if (!by_id.emplace(row.integer(id, "id", 0, 1L << 62), &row).second) {
                    row.fail(row.field(id), "id", "every disk once");
                }
            }
        }
        if (by_id.empty()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: no disks are selected: expected at least one", dump_.where(rows.header.line)));
        }
        return by_id;
    }
    /// The frame, for what the next one is compared with.
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
    /// The columns vx and vy, or none.
    [[nodiscard]] static std::vector<std::size_t> speeds_of(const FileFrame& rows) {
        std::vector<std::size_t> out;
        for (const char* name : {"vx", "vy"}) {
            const auto& names = rows.header.names;
            if (const auto at = std::find(names.begin(), names.end(), name); at != names.end()) {
                out.push_back(static_cast<std::size_t>(at - names.begin()));
            }
        }
        return out.size() == 2 ? out : std::vector<std::size_t>();
    }
    void make_periodic(Packing& packing) const {
        packing.walls = Walls::none();
        packing.cell.repeat();
        packing.cell.move(true, manifest_.tilted);
    }
    /// The bounds of a dump are the cell.
    [[nodiscard]] Sides sides_of(const FrameHeader& header) const {
        const double f = manifest_.length_factor;
        const auto& [x, y, z] = header.box.value();
        Digits digits = header.sides[0];
        digits.see(header.sides[1]);
        return {std::array{x[0] * f, y[0] * f, x[1] * f, y[1] * f}, header.tilt[0] * f, digits};
    }

    /// Walls, or both axes periodic: as the manifest says. A cell is stated once.
    void check_boundaries(const FileFrame& rows, const Sides& sides) const {
        const FrameHeader& header = rows.header;
        if (!header.not_plane.empty()) {
            throw Error(ErrorKind::bad_input, header.not_plane);
        }
        if (manifest_.periodic && sides.at && header.box) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: bounds of the cell here, and columns left, bottom, right, top in {}: expected "
                                    "one of them",
                                    dump_.where(header.line), manifest_.frames));
        }
        for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
            const Boundary boundary = header.boundary[axis];
            const bool periodic = boundary == Boundary::periodic || (sides.at && boundary == Boundary::unknown);
            if (manifest_.periodic ? !periodic || !(sides.at || header.box) : boundary == Boundary::periodic) {
                throw Error(
                    ErrorKind::bad_input,
                    fmt::format(
                        "{}: the box is {}periodic along {}: expected {}", dump_.where(header.line),
                        manifest_.periodic ? "not " : "", axis == 0 ? 'x' : 'y',
                        manifest_.periodic
                            ? "periodic boundaries with bounds (a dump with pp, XYZ with Lattice, columns left, "
                              "bottom, "
                              "right, top of the frames), the manifest has a [cell]"
                            : "walls, or a [cell] in the manifest (in XYZ pbc=\"F F F\" says that there are walls)"));
            }
        }
    }

    /// Other programs flip a box that is sheared far, by whole periods: the tilt next to the one before.
    double unflipped(Frame& frame, double tilt, double period) {
        const double periods = std::round((last_.lattice(0, 1) - tilt) / period);
        const double out = tilt + periods * period;
        if (periods != flipped_) {
            frame.note =
                fmt::format("box flipped by {} along x: the tilt {} of the file is {} here, the same lattice",
                            std::abs(periods - flipped_) == 1 ? "one period"
                                                              : fmt::format("{} periods", std::abs(periods - flipped_)),
                            tilt, out);
            flipped_ = periods;
        }
        return out;
    }

    /// Other programs wrap disks that leave the cell. Each is put where it has moved least since the frame before,
    /// relative to the first disk: contacts keep their images.
    void unwrap(Packing& packing) const {
        const auto fractions = [](const Packing& p, std::size_t i) {
            const double y = (p.q[2 * i + 1] - p.q[1]) / p.length(1);
            return std::array{(p.q[2 * i] - p.q[0] - y * p.lattice(0, 1)) / p.length(0), y};
        };
        for (std::size_t i = 1; i < packing.radius.size(); ++i) {
            const auto now = fractions(packing, i), before = fractions(last_, i);
            const double mx = std::round(before[0] - now[0]), my = std::round(before[1] - now[1]);
            packing.q[2 * i] += mx * packing.length(0) + my * packing.lattice(0, 1);
            packing.q[2 * i + 1] += my * packing.length(1);
        }
    }

    /// Forces of walls that are not 0, positive when they press the disk inwards.
    void add_walls(Frame& frame, const TextLine& row, const FileFrame& rows, int disk) {
        if (!manifest_.series.wall_forces) {
            return;
        }
        for (std::size_t w = 0; w < wall_names.size(); ++w) {
            const std::string& name = manifest_.wall_force[w];
            const double force = row.number(dump_.column(rows, name), name) * manifest_.force_factor;
            if (force != 0) {
                frame.contacts.push_back({with_wall(disk, w), w < 2 ? force : -force, dump_.where(row.number())});
            }
        }
    }

    const Manifest& manifest_;
    FrameFile dump_;
    std::vector<long> ids_;
    Packing first_, last_;
    double flipped_ = 0; ///< periods between the tilt of the file and that of the frames
};

/// Rows of the file of contacts. A contact that comes twice stays twice: `compare` names it.
void read_contacts(const Manifest& manifest, FrameFile& dump, Frame& frame) {
    const FileFrame rows = dump.at(frame.timestep);
    const std::size_t first = dump.column(rows, manifest.contact_i), second = dump.column(rows, manifest.contact_j),
                      force = dump.column(rows, manifest.contact_force);
    const char* expected = manifest.periodic ? "the id of a disk" : "the id of a disk, or left, bottom, right, top";
    const auto disk = [&](const TextLine& row, std::size_t at, const std::string& name) {
        if (row.field(at).find_first_not_of("0123456789") != std::string_view::npos) {
            row.fail(row.field(at), name, expected);
        }
        const long id = row.integer(at, name, 0, 1L << 62);
        const auto found = std::lower_bound(frame.ids.begin(), frame.ids.end(), id);
        if (found == frame.ids.end() || *found != id) {
            row.fail(row.field(at), name, expected);
        }
        return static_cast<int>(found - frame.ids.begin());
    };
    PairImages images(frame.packing);
    for (const TextLine& row : rows.rows) {
        FileContact contact;
        const auto one = wall_of(row.field(first)), other = wall_of(row.field(second));
        if (one.has_value() != other.has_value() && !manifest.periodic) {
            contact.contact = one ? with_wall(disk(row, second, manifest.contact_j), *one)
                                  : with_wall(disk(row, first, manifest.contact_i), *other);
        } else {
            const int i = disk(row, first, manifest.contact_i), j = disk(row, second, manifest.contact_j);
            if (i == j) {
                row.fail(row.field(second), manifest.contact_j, "another disk than the first");
            }
            contact.contact = images.next(i, j);
        }
        contact.force = row.number(force, manifest.contact_force) * manifest.force_factor;
        contact.row = dump.where(row.number());
        frame.contacts.push_back(std::move(contact));
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
            throw Error(ErrorKind::bad_input, files_->manifest.frames + ": no frames: expected at least one row");
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

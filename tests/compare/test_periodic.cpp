// Series of frames of a periodic cell, made from the exact run by softening: every frame is the exact equilibrium.
#include "compare/report.hpp"
#include "compare/series_copy.hpp"
#include "support/bad_input.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;
using compare::Comparison;
using compare::FrameStatus;

namespace {

constexpr double stiffness = 1e6;
constexpr double drift_per_step = 0.013;

/// Dumps as LAMMPS writes them: disks wrapped into a box that does not begin at 0, pairs without images.
class PeriodicSeries {
  public:
    /// \p flips: periods that are added to the tilt of each frame, which is the same lattice; none: as it is.
    PeriodicSeries(const std::string& name, const std::vector<double>& loads, std::vector<int> flips = {})
        : flips_(std::move(flips)) {
        State state = read_any_state(scratch::data("cells/" + name + ".json")).state;
        snap_to_grid(state.packing);
        tilted_ = state.packing.cell.tilt_moves[0];
        reference_ = {state.load.reference_length[0], state.load.reference_length[1]};
        series::run_through(state, loads, [this](const State& reached) { add(reached); });
    }

    std::string disks, contacts, frames = "timestep,sigma2\n", cell = "[cell]\n";

    /// The same as tables: the frames say where the sides of the cell are.
    [[nodiscard]] PeriodicSeries as_tables() const {
        PeriodicSeries out = *this;
        out.disks = disk_table_;
        out.contacts = contact_table_;
        out.frames = frame_table_;
        return out;
    }

    [[nodiscard]] Comparison compare(const std::optional<State>& start = {}) const {
        scratch::write(*folder_ / "disks.dump", disks);
        scratch::write(*folder_ / "contacts.dump", contacts);
        scratch::write(*folder_ / "frames.csv", frames);
        scratch::write(*folder_ / "series.toml",
                       fmt::format("format = \"isostat-series 1\"\n[files]\ndisks = \"disks.dump\"\ncontacts = "
                                   "\"contacts.dump\"\nframes = \"frames.csv\"\n[columns]\ncontact_i = "
                                   "\"i\"\ncontact_j = \"j\"\ncontact_force = \"f\"\n{}{}[law]\nkind = "
                                   "\"linear\"\nstiffness = {}\n[load]\nsigma1 = 1.0\nreference_length = [{}, {}]\n",
                                   cell, tilted_ && !cell.empty() ? "kind = \"tilted\"\n" : "", stiffness,
                                   reference_[0], reference_[1]));
        compare::SeriesReader reader(*folder_ / "series.toml");
        compare::CompareOptions options{.start = start, .bundle = 2};
        return compare::compare(reader, options);
    }

  private:
    void add(const State& state) {
        const std::vector<Contact> list = compare::carrying(state, certify(state));
        const compare::Snap exact = compare::snap({state.packing, list, state.load});
        const auto soft = required(compare::soften(exact.backbone, state.load.stress[1], stiffness));
        Packing packing = exact.packing; // rattlers where they have room
        for (std::size_t b = 0; b < exact.disks.size(); ++b) {
            std::copy_n(&soft.packing.q[2 * b], 2, &packing.q[2 * static_cast<std::size_t>(exact.disks[b])]);
        }
        std::copy(soft.packing.q.end() - 3, soft.packing.q.end(), packing.q.end() - 3);
        const double flip = flips_.empty() ? 0 : flips_[static_cast<std::size_t>(step_ / 100)];
        const double tilt = packing.lattice(0, 1) + flip * packing.length(0);
        for (std::size_t k = 0; k < 2 * packing.radius.size(); ++k) {
            packing.q[k] += drift_per_step * static_cast<double>(step_); // disks leave the cell on one side
        }
        const auto head = [&](const char* what, std::size_t rows) {
            return fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF {}\n{}\nITEM: BOX BOUNDS {}pp pp pp\n{} {}{}\n{} "
                               "{}{}\n-1 1{}\n",
                               step_, what, rows, tilted_ ? "xy xz yz " : "", low_ + std::min(tilt, 0.0),
                               low_ + packing.length(0) + std::max(tilt, 0.0), tilted_ ? fmt::format(" {}", tilt) : "",
                               low_, low_ + packing.length(1), tilted_ ? " 0" : "", tilted_ ? " 0" : "");
        };
        disks += head("ATOMS", packing.radius.size()) + "ITEM: ATOMS id x y radius\n";
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const double up = std::floor(packing.q[2 * i + 1] / packing.length(1));
            const double y = packing.q[2 * i + 1] - up * packing.length(1);
            double x = packing.q[2 * i] - up * tilt;
            x -= std::floor((x - y / packing.length(1) * tilt) / packing.length(0)) * packing.length(0);
            disks += fmt::format("{} {} {} {}\n", i + 1, x + low_, y + low_, packing.radius[i]);
            disk_table_ += fmt::format("{},{},{},{},{}\n", step_, i + 1, x + low_, y + low_, packing.radius[i]);
        }
        contacts += head("ENTRIES", list.size()) + "ITEM: ENTRIES i j f\n";
        for (std::size_t l = 0; l < list.size(); ++l) {
            contacts += fmt::format("{} {} {}\n", list[l].j + 1, list[l].i + 1, soft.forces[l]);
            contact_table_ += fmt::format("{},{},{},{}\n", step_, list[l].j + 1, list[l].i + 1, soft.forces[l]);
        }
        frames += fmt::format("{},{}\n", step_, state.load.stress[1]);
        frame_table_ += fmt::format("{},{},{},{},{},{},{}\n", step_, state.load.stress[1], low_, low_,
                                    low_ + packing.length(0), low_ + packing.length(1), tilt);
        step_ += 100;
    }

    std::vector<int> flips_;
    double low_ = -1.25;
    long step_ = 0;
    bool tilted_ = false;
    std::array<double, 2> reference_{};
    std::string disk_table_ = "timestep,id,x,y,radius\n", contact_table_ = "timestep,i,j,f\n",
                frame_table_ = "timestep,sigma2,left,bottom,right,top,tilt\n";
    std::shared_ptr<scratch::Folder> folder_ = std::make_shared<scratch::Folder>(); // copies write to the same
};

} // namespace

BOOST_AUTO_TEST_CASE(a_box_that_is_flipped_by_whole_periods_is_the_same_lattice) {
    const std::vector<double> loads{1, 1.05, 1.1, 1.15};
    const PeriodicSeries plain("tilt_16", loads), flipped("tilt_16", loads, {0, -1, -1, 2});
    const Comparison expected = plain.compare();
    for (const PeriodicSeries& series : {flipped, flipped.as_tables()}) {
        const Comparison found = series.compare();
        BOOST_TEST(found.status == expected.status);
        for (std::size_t k = 0; k < loads.size(); ++k) {
            BOOST_TEST_INFO_SCOPE("frame " << k);
            BOOST_TEST(compare::to_string(found.frames[k].status) == compare::to_string(expected.frames[k].status));
            BOOST_TEST(found.frames[k].found == expected.frames[k].found);
            BOOST_TEST(std::abs(found.frames[k].true_strain[1] - expected.frames[k].true_strain[1]) < 1e-12);
            const bool said = found.frames[k].reason.find("box flipped by") != std::string::npos;
            BOOST_TEST(said == (k == 1 || k == 3));
        }
        BOOST_TEST(found.frames[1].reason.find("by one period along x") != std::string::npos);
        BOOST_TEST(found.frames[3].reason.find("by 3 periods along x") != std::string::npos);
    }
    // The start of the exact run is described by another tilt than all frames.
    const State start = read_any_state(scratch::data("cells/tilt_16.json")).state;
    const Comparison from = PeriodicSeries("tilt_16", loads, {1, 1, 1, 1}).compare(start);
    for (std::size_t k = 0; k < loads.size(); ++k) {
        BOOST_TEST(compare::to_string(from.frames[k].status) == compare::to_string(expected.frames[k].status),
                   from.frames[k].reason);
    }
    BOOST_TEST(from.frames[0].reason.find("box flipped by one period") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(tables_of_a_periodic_cell_are_the_same_frames_as_dumps) {
    for (const char* name : {"rect_16", "tilt_16"}) {
        const PeriodicSeries series(name, {1, 1.3});
        const PeriodicSeries tables = series.as_tables();
        BOOST_TEST(compare::frames_csv(series.compare()) == compare::frames_csv(tables.compare()));
        for (const auto& [wrong, words] :
             {std::pair("timestep,sigma2,left,bottom,right,top,tilt", "bounds of the cell here, and columns left"),
              std::pair("timestep,sigma2,left,bottom,right,up,tilt", "no column 'top'"),
              std::pair("timestep,sigma2,west,south,east,north,tilt", "no column 'left'"),
              std::pair("timestep,sigma2,west,south,east,north,lean", "expected periodic boundaries with bounds")}) {
            PeriodicSeries bad = std::string(words).starts_with("bounds") ? series : tables;
            bad.frames = scratch::replaced(tables.frames, "timestep,sigma2,left,bottom,right,top,tilt", wrong);
            expect_bad_input([&] { (void)bad.compare(); }, {words});
        }
    }
}

BOOST_AUTO_TEST_CASE(frames_of_the_exact_run_in_a_cell_are_the_same_and_their_forces_are_split) {
    for (const char* name : {"rect_16", "tilt_16"}) {
        BOOST_TEST_INFO_SCOPE(name);
        const Comparison result = PeriodicSeries(name, {1, 1.3, 1.45, 1.9, 2.0}).compare();
        series::are_same(result, 5U);
        for (const compare::FrameResult& frame : result.frames) {
            BOOST_TEST(frame.counting.hyperstaticity == 0);
            BOOST_TEST(frame.law < 1e-6);
            BOOST_TEST(frame.rest < 1e-6);
            BOOST_TEST(frame.stiffness > frame.rest);
            BOOST_TEST(frame.stiffness < 1e-2);
            BOOST_TEST(frame.distance < 1e-3);
        }
    }
}

BOOST_AUTO_TEST_CASE(damaged_frames_of_a_cell_are_named) {
    PeriodicSeries damaged("rect_16", {1, 1.01});
    const auto expect_file = [](const Comparison& result, const std::string& words) {
        series::is_file(result.frames[1], words);
        BOOST_TEST((result.frames[0].status == FrameStatus::same));
    };
    const std::string contacts = damaged.contacts;
    const std::size_t last = contacts.rfind('\n', contacts.size() - 2) + 1;
    std::string row = contacts.substr(last);
    damaged.contacts.replace(last, std::string::npos, row.substr(0, row.rfind(' ')) + " 0.0001\n");
    expect_file(damaged.compare(), "force");
    const std::size_t before = contacts.rfind('\n', last - 2) + 1;
    damaged.contacts = contacts.substr(0, before) + row + row; // in the place of the row before
    expect_file(damaged.compare(), "come twice");
    damaged.contacts = contacts;
    damaged.frames = scratch::replaced(damaged.frames, "100,1.01", "100,1.011");
    expect_file(damaged.compare(), "period along y");
}

BOOST_AUTO_TEST_CASE(a_cell_and_its_manifest_must_agree) {
    PeriodicSeries series("rect_16", {1});
    const auto refuses = [&](const std::string& words) { expect_bad_input([&] { (void)series.compare(); }, {words}); };
    series.cell = "";
    refuses("no column 'left'");
    series.frames = "timestep,sigma2,left,bottom,right,top\n0,1,0,0,9,9\n";
    refuses("walls, or a [cell] in the manifest");
    series.cell = "[cell]\nkind = \"cubic\"\n";
    refuses("cubic");
    series.cell = "[cell]\n";
    series.frames = "timestep,sigma2\n0,1\n";
    series.disks = scratch::replaced(series.disks, "pp pp pp", "pp ff pp");
    refuses("the box is not periodic along y");
}

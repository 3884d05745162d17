// Series of frames of soft spheres, made from the exact run by overlaps: every frame is the exact equilibrium.
#include "compare/series_copy.hpp"
#include "support/bad_input.hpp"
#include "support/newton.hpp"
#include "support/spheres.hpp"

using namespace isostat;
using compare::Comparison;
using compare::ForceLaw;
using compare::FrameStatus;

namespace {

constexpr std::array sphere_stiffness{1e7, 1e10}; // of the laws
constexpr double sphere_drift = 0.013;
constexpr std::array law_names{"linear", "hertz"};

/// The place where the gaps of the contacts are minus the overlaps.
Packing overlapping(const State& state, const std::vector<double>& overlaps) {
    Packing packing = state.packing;
    std::vector<double> gaps(overlaps.size());
    std::ranges::transform(overlaps, gaps.begin(), std::negate());
    for (int turn = 0; turn < 5; ++turn) {
        crafted::step_to_gaps(packing, state.contacts, gaps);
    }
    return packing;
}

/// Tables of frames; spheres of a cell are wrapped, and a triclinic cell is described by other tilts in each frame.
class SphereSeries {
  public:
    SphereSeries(const std::string& name, const std::vector<double>& loads, ForceLaw law, const StressRates& path = {})
        : law_(law), path_(path != StressRates{}) {
        State state = test::on_its_lengths(test::state_of_spheres(test::read_spheres(name)));
        snap_to_grid(state.packing);
        periodic_ = state.packing.cell.any();
        tilted_ = state.packing.cell.shears();
        load = state.load;
        if (path_) {
            state.load.follow(path);
        }
        frames = periodic_ ? "timestep,sigma3,left,bottom,back,right,top,front,tilt_xy,tilt_xz,tilt_yz\n"
                           : "timestep,sigma3,left,bottom,back,right,top,front\n";
        frames = path_ ? scratch::replaced(frames, "sigma3", "sigma1,sigma2,sigma3") : frames;
        series::run_through(state, loads, [this](const State& reached) { add(reached); });
    }

    Load load;
    std::string spheres = "timestep,id,x,y,z,radius\n", contacts = "timestep,i,j,f\n", frames;

    [[nodiscard]] Comparison compare() const {
        scratch::write(*folder_ / "spheres.csv", spheres);
        scratch::write(*folder_ / "contacts.csv", contacts);
        scratch::write(*folder_ / "frames.csv", frames);
        scratch::write(*folder_ / "series.toml",
                       fmt::format("format = \"isostat-series 1\"\n[files]\ndisks = \"spheres.csv\"\ncontacts = "
                                   "\"contacts.csv\"\nframes = \"frames.csv\"\n[columns]\ncontact_i = "
                                   "\"i\"\ncontact_j = \"j\"\ncontact_force = \"f\"\n{}{}[law]\nkind = "
                                   "\"{}\"\nstiffness = {}\n[load]\n{}reference_length = [{}, {}, {}]\n",
                                   periodic_ ? "[cell]\n" : "", tilted_ ? "kind = \"tilted\"\n" : "",
                                   law_names[static_cast<std::size_t>(law_)], stiffness_,
                                   path_ ? std::string()
                                         : fmt::format("sigma1 = {}\nsigma2 = {}\n", load.stress[0], load.stress[1]),
                                   load.reference_length[0], load.reference_length[1], load.reference_length[2]));
        compare::SeriesReader reader(*folder_ / "series.toml");
        return compare::compare(reader, {.start = {}, .bundle = 2});
    }

  private:
    void add(const State& state) {
        const compare::Snap exact = compare::snap({state.packing, compare::carrying(state), state.load});
        std::vector<double> overlaps, forces;
        for (std::size_t l = 0; l < exact.backbone.contacts.size(); ++l) {
            const Contact& c = exact.backbone.contacts[l];
            forces.push_back(0.5 * (exact.truth.finite[l].lower + exact.truth.finite[l].upper));
            const auto radius = [&](int i) { return exact.backbone.packing.radius[static_cast<std::size_t>(i)]; };
            const double root =
                std::sqrt(c.kind != ContactKind::disk_disk ? radius(c.i)
                                                           : radius(c.i) * radius(c.j) / (radius(c.i) + radius(c.j)));
            overlaps.push_back(law_ == ForceLaw::linear ? forces[l] / stiffness_
                                                        : std::pow(forces[l] / (stiffness_ * root), 2.0 / 3));
        }
        const Packing soft = overlapping(exact.backbone, overlaps);
        Packing packing = exact.packing; // rattlers where they have room
        for (std::size_t b = 0; b < exact.disks.size(); ++b) {
            std::copy_n(&soft.q[3 * b], 3, &packing.q[3 * static_cast<std::size_t>(exact.disks[b])]);
        }
        std::copy(soft.q.begin() + static_cast<std::ptrdiff_t>(soft.length_at(0)), soft.q.end(),
                  packing.q.begin() + static_cast<std::ptrdiff_t>(packing.length_at(0)));
        write_frame(state, packing);
        for (std::size_t l = 0; l < forces.size(); ++l) {
            const Contact& c = exact.backbone.contacts[l];
            const auto id = [&](int i) { return exact.disks[static_cast<std::size_t>(i)] + 1; };
            const std::string other = c.kind == ContactKind::disk_disk
                                          ? std::to_string(id(c.j))
                                          : to_string(Contact{c.kind, 0, c.j}, 3).substr(2);
            contacts += fmt::format("{},{},{},{}\n", step_, other, id(c.i), forces[l]);
        }
        step_ += 100;
    }

    void write_frame(const State& state, const Packing& packing) {
        const PerAxis<double>& stress = state.load.stress;
        frames += fmt::format("{},{}{},0,0,0,{},{},{}", step_,
                              path_ ? fmt::format("{},{},", stress[0], stress[1]) : std::string(), stress[2],
                              packing.length(0), packing.length(1), packing.length(2));
        const std::array<double, 3> flips{0, 1, -1}; // periods along y, and twice as many along x
        const double flip = tilted_ ? flips.at(static_cast<std::size_t>(step_ / 100)) : 0;
        if (periodic_) {
            const double xy = packing.lattice(0, 1), xz = packing.lattice(0, 2), yz = packing.lattice(1, 2);
            frames += fmt::format(",{},{},{}", xy - flip * packing.length(0),
                                  xz + flip * xy + 2 * flip * packing.length(0), yz + flip * packing.length(1));
        }
        frames += "\n";
        const std::size_t n = packing.radius.size();
        for (std::size_t i = 0; i < n; ++i) {
            PerAxis<double> at{packing.q[3 * i], packing.q[3 * i + 1], packing.q[3 * i + 2]};
            for (std::size_t b = 3; periodic_ && b-- > 0;) {
                at[b] += sphere_drift * static_cast<double>(step_); // spheres leave the cell on one side
            }
            for (std::size_t b = 3; periodic_ && b-- > 0;) {
                const double periods = std::floor(at[b] / packing.lattice(b, b));
                for (std::size_t a = 0; a <= b; ++a) {
                    at[a] -= periods * packing.lattice(a, b);
                }
            }
            spheres += fmt::format("{},{},{},{},{},{}\n", step_, i + 1, at[0], at[1], at[2], packing.radius[i]);
        }
    }

    ForceLaw law_;
    double stiffness_ = sphere_stiffness.at(static_cast<std::size_t>(law_));
    long step_ = 0;
    bool path_, periodic_ = false, tilted_ = false;
    std::shared_ptr<scratch::Folder> folder_ = std::make_shared<scratch::Folder>(); // copies write to the same
};

} // namespace

BOOST_AUTO_TEST_CASE(frames_of_the_exact_run_of_spheres_are_the_same_under_both_laws) {
    for (const auto& [name, law] :
         {std::pair("box_uniform_30_1", ForceLaw::linear), std::pair("box_uniform_30_1", ForceLaw::hertz),
          std::pair("ortho_uniform_30_1", ForceLaw::linear), std::pair("tri_uniform_30_1", ForceLaw::linear)}) {
        BOOST_TEST_INFO_SCOPE(name << ", law " << law_names[static_cast<std::size_t>(law)]);
        const bool box = std::string(name).starts_with("box");
        const Comparison result =
            SphereSeries(name, box ? std::vector<double>{1, 1.1, 1.3} : std::vector<double>{1, 1.01, 1.06}, law)
                .compare();
        BOOST_TEST(result.dimension == 3);
        series::are_same(result, 3U);
        for (const compare::FrameResult& frame : result.frames) {
            BOOST_TEST(frame.law < 1e-3);
            BOOST_TEST(frame.rest < 1e-2);
            BOOST_TEST(frame.distance < 1e-2);
            BOOST_TEST(std::abs(frame.strain[2] - frame.true_strain[2]) < 1e-3);
        }
        const bool flipped = result.frames[1].reason.find("box flipped by") != std::string::npos;
        BOOST_TEST(flipped == (std::string(name) == "tri_uniform_30_1"), result.frames[1].reason);
    }
}

BOOST_AUTO_TEST_CASE(frames_of_spheres_that_contradict_themselves_are_named) {
    SphereSeries series("box_uniform_30_1", {1, 1.1}, ForceLaw::linear);
    const auto expect_file = [&](const std::string& words) {
        const Comparison result = series.compare();
        series::is_file(result.frames[1], words);
        BOOST_TEST((result.frames[0].status == FrameStatus::same), result.frames[0].reason);
    };
    const std::string contacts = series.contacts;
    const std::size_t last = contacts.rfind('\n', contacts.size() - 2) + 1;
    const std::string row = contacts.substr(last);
    series.contacts = scratch::replaced(contacts, row, row.substr(0, row.rfind(',')) + ",500\n");
    expect_file("stiffness x overlap");
    series.contacts = contacts + row;
    expect_file("come twice");
    series.contacts = contacts;
    series.frames = scratch::replaced(series.frames, "100,1.1,", "100,1.12,");
    expect_file("front wall");
}

/// sigma1 and sigma2 fall as sigma3 rises: a path in stress space.
BOOST_AUTO_TEST_CASE(frames_of_a_run_in_which_all_stresses_change_are_the_same_or_named) {
    const State start = test::on_its_lengths(test::state_of_spheres(test::read_spheres("box_uniform_30_1")));
    const PerAxis<double>& s = start.load.stress;
    SphereSeries series("box_uniform_30_1", {0, 0.03, 0.08}, ForceLaw::linear, {-s[0], -s[1], 2 * s[2]});
    const Comparison result = series.compare();
    series::are_same(result, 3);
    BOOST_TEST(result.frames.back().stress == s[2] / s[0] * 1.16 / 0.92, boost::test_tools::tolerance(1e-12));
    // The same frames under the stresses of another one, and in another proportion.
    const std::string frames = series.frames;
    const auto row = frames.find("\n200,") + 1;
    const std::string last = frames.substr(row), sigma1 = last.substr(4, last.find(',', 4) - 4);
    series.frames = frames.substr(0, row) + "200,1.5" + last.substr(4 + sigma1.size());
    expect_bad_input([&] { (void)series.compare(); }, {"in the proportion to sigma1"});
    series.frames =
        frames.substr(0, row) + fmt::format("200,{},{},{}", s[0], s[1], s[2]) + last.substr(last.find(",0,0,0,"));
    BOOST_TEST((series.compare().frames.back().status == FrameStatus::file));
}

BOOST_AUTO_TEST_CASE(stresses_of_three_axes_are_those_of_the_manifest_or_refused) {
    SphereSeries series("box_uniform_30_1", {1}, ForceLaw::linear);
    const std::string frames = series.frames;
    const auto with_stress = [&](double factor) {
        series.frames = scratch::replaced(frames, "sigma3,", "sigma3,sigma1,");
        const std::string stress = fmt::format("0,1,{},", factor * series.load.stress[0]);
        series.frames = scratch::replaced(series.frames, "\n0,1,", "\n" + stress);
    };
    with_stress(1);
    BOOST_TEST(series.compare().status == 0);
    const auto refuses = [&](const std::string& words) { expect_bad_input([&] { (void)series.compare(); }, {words}); };
    with_stress(1.001);
    refuses("the one of the manifest");
    series.frames = scratch::replaced(frames, "front", "top2");
    refuses("no column 'front'");
    series.frames = frames;
    series.load.stress[1] = 0;
    refuses("sigma2");
}

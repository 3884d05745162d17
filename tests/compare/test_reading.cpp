// What makes the forces of a frame differ from those of the law: an error of the files, dashpots, or their digits.
#include "compare/report.hpp"
#include "compare/series_copy.hpp"

using namespace isostat;
using compare::Comparison;
using compare::FrameStatus;
using series::Copy;

namespace {

bool says(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

/// Frame 1 of two with velocities and the dashpots that go with them: m v_n, m_i m_j / (m_i + m_j) of m = R^power, of
/// walls m_i, which stand still for them.
class Slow {
  public:
    Slow(double speed, int power) : power_(power) {
        std::mt19937_64 random(17);
        std::uniform_real_distribution<double> noise(-1, 1);
        std::string& names = copy.disks[Copy::line(copy.disks, 1, 0) - 1];
        names += " vx vy";
        for (std::size_t row = 0; row < 100; ++row) {
            std::string& line = copy.disk(1, row);
            const series::Lines words = series::words_of(line);
            Grain g{std::stod(words[2]), std::stod(words[3]), std::stod(words[4]), 0, 0};
            g.vx = speed * (g.x / 15 + 0.3 * noise(random));
            g.vy = speed * (-g.y / 15 + 0.3 * noise(random));
            grains_[words[0]] = g;
            line += fmt::format(" {} {}", g.vx, g.vy);
            press_walls(line, g);
        }
        for (std::size_t at = Copy::line(copy.contacts, 1, 0); at < copy.contacts.size(); ++at) {
            const series::Lines words = series::words_of(copy.contacts[at]);
            const Grain &a = grains_.at(words[0]), &b = grains_.at(words[1]);
            const double dx = b.x - a.x, dy = b.y - a.y, far = std::hypot(dx, dy);
            const double closing = -((b.vx - a.vx) * dx + (b.vy - a.vy) * dy) / far;
            const double ma = std::pow(a.r, power_), mb = std::pow(b.r, power_);
            Copy::change(copy.contacts[at], 2, 1, closing * (power_ == 0 ? 1 : ma * mb / (ma + mb)));
        }
    }
    Copy copy{2};
    void forget_velocities() {
        std::string& names = copy.disks[Copy::line(copy.disks, 1, 0) - 1];
        names = scratch::replaced(names, " vx vy", " ux uy");
    }
    [[nodiscard]] compare::FrameResult result() const { return copy.compare().frames.at(1); }

  private:
    struct Grain {
        double r, x, y, vx, vy;
    };
    /// left, right, bottom, top: columns 5 to 8.
    void press_walls(std::string& line, const Grain& g) const {
        for (std::size_t wall = 0; wall < 4; ++wall) {
            if (std::stod(series::words_of(line)[5 + wall]) != 0) {
                Copy::change(line, 5 + wall, 1, -(wall < 2 ? g.vx : g.vy) * std::pow(g.r, power_));
            }
        }
    }
    int power_;
    std::map<std::string, Grain> grains_;
};

/// So many significant digits.
std::string cut(const std::string& number, int digits) {
    return fmt::format("{:.{}g}", std::stod(number), digits);
}

/// Of the coordinates in a row of a dump.
void cut_place(std::string& line, int digits) {
    for (const std::size_t k : {3U, 4U}) {
        line = Copy::field(line, k, cut(series::words_of(line)[k], digits));
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(dashpots_of_a_slow_frame_are_told_from_wrong_forces_by_the_velocities) {
    // The forces of the law balance to 1e-8: that alone said that the files are wrong.
    for (const int power : {3, 2, 0}) {
        const Slow slow(0.1, power);
        const compare::FrameResult frame = slow.result();
        BOOST_TEST((frame.status == FrameStatus::moving), frame.reason);
        BOOST_TEST(says(frame.reason, "dashpot, 1 times the speed"), frame.reason);
        BOOST_TEST(frame.law > 1e-3);
    }
    Slow wrong(0.1, 3); // and one force is wrong
    Copy::change(wrong.copy.contact(1, 20), 2, 1.2);
    BOOST_TEST((wrong.result().status == FrameStatus::file));
}

BOOST_AUTO_TEST_CASE(dashpots_without_velocities_are_told_by_what_the_law_leaves) {
    // A disk is off its place of rest by 1.5e-8, 5e-4 of a mean force: the law leaves less than a frame at rest may,
    // and a part of what the files leave.
    Slow slow(0.04, 3);
    slow.forget_velocities();
    Copy::change(slow.copy.disk(1, 2), 3, 1, 1.5e-8);
    const compare::FrameResult frame = slow.result();
    BOOST_TEST((frame.status == FrameStatus::moving), frame.reason);
    BOOST_TEST(says(frame.reason, "dashpots may be at work"), frame.reason);
}

BOOST_AUTO_TEST_CASE(the_digits_of_the_files_are_no_contradiction) {
    const auto rounded = [](int digits, double units) {
        Copy copy(2);
        for (std::size_t row = 0; row < 100; ++row) {
            cut_place(copy.disk(1, row), digits);
        }
        for (std::size_t at = Copy::line(copy.contacts, 1, 0); at < copy.contacts.size(); ++at) {
            Copy::change(copy.contacts[at], 2, units);
        }
        series::Lines cells = series::words_of(copy.table[2], ',');
        for (const std::size_t k : {3U, 4U, 6U}) { // walls, the force on the top wall
            cells[k] = cut(cells[k], digits);
        }
        copy.table[2] = series::joined(cells, ',');
        return copy.compare().frames.at(1);
    };
    for (const int digits : {6, 8, 10}) {
        const compare::FrameResult frame = rounded(digits, 1);
        BOOST_TEST((frame.status == FrameStatus::same), digits << " digits: " << frame.reason);
        BOOST_TEST(says(frame.reason, "digits of the files") == (digits < 10), frame.reason);
    }
    BOOST_TEST((rounded(8, 1000).status == FrameStatus::file)); // other units are beyond them
}

BOOST_AUTO_TEST_CASE(overlaps_that_digits_hide_leave_a_frame_without_forces_undecided) {
    Copy copy(1);
    copy.restate("contacts = \"contacts.dump\"", "");
    for (const std::string key : {"contact_i", "contact_j", "contact_force"}) {
        copy.restate(key, "# " + key);
    }
    BOOST_TEST((copy.compare().frames.at(0).status == FrameStatus::same));
    for (std::size_t row = 0; row < 100; ++row) {
        cut_place(copy.disk(0, row), 6);
    }
    const compare::FrameResult frame = copy.compare().frames.at(0);
    BOOST_TEST((frame.status == FrameStatus::undecided), frame.reason);
    BOOST_TEST(says(frame.reason, "within the digits of the files"), frame.reason);
}

BOOST_FIXTURE_TEST_CASE(the_figure_is_drawn_where_there_is_no_exact_run, scratch::InFolder) {
    // Every frame is refused, so there is no exact run: gnuplot does not count blocks without a line.
    Copy copy(2);
    copy.restate("stiffness = 1e5", "stiffness = 2e5");
    compare::SeriesReader reader(copy.write());
    const Comparison result = compare::compare(reader);
    BOOST_TEST(result.path.empty());
    const std::string failure = compare::write_comparison(folder / "out", reader.series(), result);
    const std::string data = scratch::read(folder / "out" / "comparison.dat");
    const std::string script = scratch::read(folder / "out" / "comparison.gp");
    BOOST_TEST(!says(script, "exact run"));
    BOOST_TEST(says(script, "\"comparison.dat\" index 0 with points"));
    BOOST_TEST(data.find("# frames") == 0U);
    if (!says(failure, "cannot be started")) { // gnuplot is there
        BOOST_TEST(failure.empty(), failure);
        BOOST_TEST(std::filesystem::file_size(folder / "out" / "comparison.svg") > 1000U);
    }
}

// Inspection of exact packings: what must be refused, invariances, agreement with independent counts, large lattices.
// Every file of examples/packings is read, inspected and held against the answers it carries.
#include "examples.hpp"
#include "support/bad_input.hpp"
#include "support/exact_lattices.hpp"
#include "support/scratch.hpp"

#include <isostat/rigidity/counting.hpp>

#include <chrono>

namespace {

using namespace examples;
using namespace isostat::crafted;
namespace crafted = isostat::crafted;
using isostat::Contact;
using isostat::ContactKind;
using isostat::Error;
using isostat::Verdict;

std::string contents(const std::string& name) {
    return scratch::read(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name);
}

/// rows x columns triangular lattice of unit disks in its box, odd rows shifted by one radius.
ExactPacking triangular(int rows, int columns, bool box) {
    ExactPacking packing = families::triangular_lattice(columns, rows);
    if (!box) {
        packing.walls = ExactPacking().walls;
        packing.length = ExactPacking().length;
    }
    return packing;
}

void refused(const std::string& text, int line, const std::string& part) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_packing(text, "file.toml"); }, {fmt::format("file.toml:{}:", line), part});
}

const std::string head = "format = \"isostat-packing 1\"\n";

} // namespace

BOOST_AUTO_TEST_CASE(bad_files_are_refused_with_line_and_what_was_expected) {
    refused("disks = [[0, 0, 1]]\n", 1, "no format: expected \"isostat-packing 1\"");
    refused("format = \"isostat-packing 2\"\n", 1, "expected \"isostat-packing 1\"");
    refused(head, 1, "no disk");
    refused(head + "disks = [[0, 0]]\n", 2, "array of 3");
    refused(head + "disks = [[0, 0, -1]]\n", 2, "above 0");
    refused(head + "disks = [[0, 0, 0]]\n", 2, "above 0");
    refused(head + "disks = [[nan, 0, 1]]\n", 2, "exact number");
    refused(head + "disks = [[0, inf, 1]]\n", 2, "exact number");
    refused(head + "disks = [[0, 0, 1],\n[true, 0, 1]]\n", 3, "is true: expected a number");
    refused(head + "disks = [[0, 0, \"sin(1)\"]]\n", 2, "position 1");
    refused(head + "disks = [[0, 0, 1]\n", 2, "end-of-file");
    refused(head + "disks = [[0, 0, 1]]\n[boxes]\n", 3, "unknown key 'boxes': expected one of format, ");
    refused(head + "disks = [[0, 0, 1]]\n[boxes]\n", 3, "cell, box, bodies, load, expected");
    refused(head + "[[disk]]\nx = 0\ny = 0\nr = 1\nz = 1\n", 6,
            "unknown key 'z' in [disk]: expected one of x, y, r, fixed");
    refused(head + "[[disk]]\nx = 0\nr = 1\n", 2, "no y in [disk]");
    refused(head + "disks = [[0, 0, 1]]\n[box]\nlength = [1, -1]\n", 4, "above 0");
    refused(head + "disks = [[0, 0, 1]]\n[box]\nlength = [2, 2]\nlower = [\"movable\", \"fixed\"]\n", 5,
            "\"absent\" or \"fixed\"");
    refused(head + "disks = [[0, 0, 1]]\n[load]\nwall = [1, 0]\n", 4, "not movable");
    refused(head + "disks = [[0, 0, 1]]\n[load]\ndisk = [[1, 0, 0]]\n", 4, "0 to 0");
}

BOOST_AUTO_TEST_CASE(bad_cells_are_refused_with_line_and_what_was_expected) {
    const std::string disk = head + "disks = [[0, 0, 1]]\n";
    const std::string cell = disk + "[cell]\nmoves = [\"x\", \"y\"]\n";
    refused(disk + "[cell]\nperiod = [3, 3]\n", 3, "no moves in [cell]");
    refused(cell, 3, "no period in [cell]");
    refused(cell + "period = [3, 0]\n", 5, "above 0");
    refused(cell + "period = [3, \"-sqrt(3)\"]\n", 5, "above 0");
    refused(cell + "period = [3]\n", 5, "an array of 2");
    refused(cell + "period = [\"none\", \"none\"]\n", 5, "a box has no [cell]");
    refused(disk + "[cell]\nperiod = [3, 3]\nmoves = [\"xy\", \"xy\"]\n", 5, "each once");
    refused(disk + "[cell]\nperiod = [3, \"none\"]\nmoves = [\"y\"]\n", 5, "that repeats");
    refused(disk + "[cell]\nperiod = [3, \"none\"]\nmoves = [\"xy\"]\n", 5, "that repeats");
    refused(disk + "[cell]\nperiod = [3, \"none\"]\nmoves = []\ntilt = 1\n", 6, "0, as one axis");
    refused(cell + "period = [3, 3]\npin = 1\n", 6, "0 to 0");
    // A grain wider than the cell overlaps its own image; exactly as wide is allowed.
    refused(cell + "period = [\"2 - 1e-30\", 3]\n", 5, "overlaps its own image");
    refused(cell + "period = [3, \"sqrt(3) - 1e-30\"]\ntilt = 1\n", 5, "overlaps its own image");
    BOOST_CHECK_NO_THROW((void)parse_packing(cell + "period = [2, \"sqrt(3)\"]\ntilt = 1\n", "file.toml"));
    refused(head + "disks = [[100, 0, 1]]\n[cell]\nmoves = []\nperiod = [3, 3]\n", 5, "put it into the cell");
    refused(head + "[[disk]]\nx = 0\ny = 0\nr = 1\nfixed = true\n[cell]\nperiod = [3, 3]\nmoves = []\n", 7,
            "no fixed disk");
    const std::string walls = cell + "period = [3, 3]\n[box]\n";
    refused(walls + "lower = [\"absent\", \"fixed\"]\n", 7, "y repeats");
    refused(walls + "upper = [\"movable\", \"absent\"]\n", 7, "x repeats");
    refused(walls + "length = [3, 3]\n", 7, "\"none\" for an absent wall");
    refused(cell + "period = [3, 3]\n[load]\ntilt = 1\n", 7, "no tilt of a cell moves");
    refused(disk + "[cell]\nmoves = [\"x\"]\nperiod = [3, 3]\n[load]\nwall = [1, 1]\n", 7,
            "the period along this axis does not move");
    refused(cell + "period = [3, 3]\n[load]\ndisk = [[0, 0, 1]]\n", 7, "0 along y");
}

BOOST_AUTO_TEST_CASE(floats_are_read_from_their_source_text) {
    const PackingFile file = parse_packing(head + "disks = [[0.1, 1_000.5, 1e-3], [ -2.5e+1,3.0 , 0.3]]\n", "f");
    BOOST_TEST((file.packing.centre[0][0] == n("1/10")));
    BOOST_TEST((file.packing.centre[0][1] == n("2001/2")));
    BOOST_TEST((file.packing.radius[0] == n("1/1000")));
    BOOST_TEST((file.packing.centre[1][0] == n("-25")));
    BOOST_TEST((file.packing.centre[1][1] == n("3")));
    BOOST_TEST((file.packing.radius[1] == n("3/10")));
    // The columns of a line with characters of several bytes before the number.
    const PackingFile inline_table =
        parse_packing(head + "title = \"d\xC3\xA9j\xC3\xA0\"\ndisk = [{\"x\" = 0.1, \"y\" = 0.2, \"r\" = 0.7}]\n", "f");
    BOOST_TEST((inline_table.packing.radius[0] == n("7/10")));
    const PackingFile wide = parse_packing(head + "disks = [[\"1\", 0, 0.1]] # \xE2\x88\x9A\n", "f");
    BOOST_TEST((wide.packing.radius[0] == n("1/10")));
}

BOOST_AUTO_TEST_CASE(each_wrong_expectation_is_reported) {
    for (const char* name : {"three_disks_and_a_rattler.toml", "cell_two_disks_tilted.toml"}) {
        PackingFile file = parse_packing(contents(name), "three");
        const crafted::Inspection inspection = inspected(file.packing);
        BOOST_REQUIRE(check_expected(inspection, file, "three").empty());
        for (std::size_t e = 0; e < file.expected.size(); ++e) {
            PackingFile wrong = file;
            auto& entry = wrong.expected[e];
            if (entry.values.empty()) {
                entry.values.push_back({"0"});
            } else {
                entry.values.back().back() = "12345";
            }
            BOOST_TEST(check_expected(inspection, wrong, "three").size() == 1u, entry.key);
        }
        PackingFile unknown = file;
        unknown.expected.push_back({"colour", {{"red"}}, 99});
        BOOST_CHECK_THROW((void)check_expected(inspection, unknown, "three"), Error);
    }
}

BOOST_AUTO_TEST_CASE(overlap_is_named_however_small) {
    for (const char* depth : {"1", "1e-16", "1e-200"}) {
        ExactPacking packing;
        packing.centre = {
            {Number(0), Number(0)}, {n("sqrt(2)"), n(std::string("sqrt(2) - ") + depth)}, {Number(50), Number(0)}};
        packing.radius = {Number(1), Number(1), Number(1)};
        const auto failure = fails(exact_contacts(packing), isostat::FailureKind::overlap, {"disk 0", "disk 1"});
        BOOST_TEST((failure.disks() == std::vector<int>{0, 1}));
        packing.centre[1][1] = n(std::string("sqrt(2) + ") + depth);
        BOOST_REQUIRE(exact_contacts(packing).ok());
        BOOST_TEST(exact_contacts(packing).value().empty());
        packing.centre[1][1] = n("sqrt(2)");
        BOOST_TEST(exact_contacts(packing).value().size() == 1u);
    }
    ExactPacking wall = triangular(2, 2, true);
    wall.length[0] -= n("1e-100");
    BOOST_TEST(!exact_contacts(wall).ok());
}

BOOST_AUTO_TEST_CASE(contacts_agree_with_every_pair_decided_in_the_field) {
    std::mt19937_64 random(23);
    int contacts = 0, overlaps = 0;
    for (int k = 0; k < 400; ++k) {
        // Points of two lattices with many exact tangencies, at scales down to 1e-150 and up to 1e150.
        const Number scale = n(fmt::format("1e{}", static_cast<int>(random() % 7) * 50 - 150));
        ExactPacking packing;
        for (int i = 0; i < 6; ++i) {
            const Number u(static_cast<int>(random() % 9)), v(static_cast<int>(random() % 9));
            const bool hexagonal = random() % 2 == 0;
            packing.centre.push_back(
                {(hexagonal ? u + v / Number(2) : u) * scale, (hexagonal ? v * n("1/2*sqrt(3)") : v) * scale});
            packing.radius.push_back(scale / Number(2));
        }
        std::vector<Contact> expected;
        bool overlap = false;
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = i + 1; j < 6; ++j) {
                const Number dx = packing.centre[i][0] - packing.centre[j][0],
                             dy = packing.centre[i][1] - packing.centre[j][1];
                const int sign = (dx * dx + dy * dy - scale * scale).sign();
                overlap = overlap || sign < 0;
                if (sign == 0) {
                    expected.push_back({ContactKind::disk_disk, static_cast<int>(i), static_cast<int>(j)});
                }
            }
        }
        const auto found = exact_contacts(packing);
        BOOST_REQUIRE_EQUAL(found.ok(), !overlap);
        overlaps += overlap ? 1 : 0;
        if (!overlap) {
            BOOST_REQUIRE(found.value() == expected);
            contacts += static_cast<int>(expected.size());
        }
    }
    BOOST_TEST(contacts > 50);
    BOOST_TEST(overlaps > 50);
}

BOOST_AUTO_TEST_CASE(relabelling_scaling_and_turning_leave_the_counts_alone) {
    std::mt19937_64 random(29);
    int cases = 0;
    for (const std::string& path : packing_files()) {
        const ExactPacking packing = read_packing(path).packing;
        const crafted::Inspection before = inspected(packing);
        ExactPacking other = packing;
        std::vector<std::size_t> label(packing.radius.size());
        std::iota(label.begin(), label.end(), std::size_t{0});
        std::ranges::shuffle(label, random);
        const bool turns = packing.walls == isostat::Walls::none() && !packing.cell.any();
        const Number scale = n("7/3"), c = turns ? n("3/5") : Number(1), s = turns ? n("4/5") : Number(0);
        const auto turned = [&](const Number& x, const Number& y) {
            return std::array<Number, 2>{c * x - s * y, s * x + c * y};
        };
        for (std::size_t i = 0; i < label.size(); ++i) {
            const std::size_t to = label[i];
            const auto centre = turned(packing.centre[i][0], packing.centre[i][1]);
            other.centre[to] = {scale * centre[0], scale * centre[1]};
            other.radius[to] = scale * packing.radius[i];
            if (!packing.fixed.empty()) {
                other.fixed[to] = packing.fixed[i];
            }
            if (packing.load && !packing.load->disk.empty()) {
                const auto force = turned(packing.load->disk[2 * i], packing.load->disk[2 * i + 1]);
                other.load->disk[2 * to] = force[0];
                other.load->disk[2 * to + 1] = force[1];
            }
        }
        other.length = {scale * packing.length[0], scale * packing.length[1]};
        other.tilt[0] = scale * packing.tilt[0];
        const crafted::Inspection after = inspected(other);
        BOOST_TEST_CONTEXT(path) {
            BOOST_TEST(after.dof_count == before.dof_count);
            BOOST_TEST(after.contacts.size() == before.contacts.size());
            BOOST_TEST(after.rank == before.rank);
            BOOST_TEST(after.generic_rank == before.generic_rank);
            BOOST_TEST((after.special_position == before.special_position));
            BOOST_TEST((after.support == before.support));
            BOOST_TEST((after.one_sign.kind == before.one_sign.kind));
            BOOST_TEST((after.second_order == before.second_order));
            BOOST_TEST((after.stable == before.stable));
            for (std::size_t i = 0; i < label.size(); ++i) {
                BOOST_TEST((after.hold[label[i]] == before.hold[i]));
            }
        }
        ++cases;
    }
    BOOST_TEST(cases >= 25);
}

BOOST_AUTO_TEST_CASE(bases_are_in_the_kernel_and_count_as_they_should) {
    for (const auto& [rows, columns] : {std::pair{2, 3}, std::pair{3, 3}, std::pair{4, 5}, std::pair{1, 4}}) {
        for (const bool box : {false, true}) {
            const ExactPacking packing = triangular(rows, columns, box);
            const crafted::Inspection inspection = inspected(packing);
            BOOST_REQUIRE((inspection.bases_exact == Verdict::proved));
            const auto h = static_cast<std::size_t>(inspection.hyperstaticity),
                       k = static_cast<std::size_t>(inspection.mechanisms);
            BOOST_TEST(inspection.self_stresses.size() == h);
            BOOST_TEST(inspection.motions.size() == k);
            BOOST_TEST(static_cast<std::size_t>(inspection.dof_count) + h == inspection.contacts.size() + k);
            const isostat::DofMap dofs(approximate(packing));
            const auto matrix = exact_contact_matrix(packing, dofs, inspection.contacts);
            for (const auto& stress : inspection.self_stresses) {
                for (const Number& x : product(matrix, stress)) {
                    BOOST_REQUIRE(x.is_zero());
                }
            }
            for (const auto& motion : inspection.motions) {
                for (const Number& x : product(transposed(matrix), motion)) {
                    BOOST_REQUIRE(x.is_zero());
                }
            }
            BOOST_TEST(inspection.internal_mechanisms() >= 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(rational_packings_count_as_in_double_with_the_same_contacts) {
    // Two independent codes: the field here, residues of the stored doubles there (dyadic coordinates are the same
    // packing).
    for (int m = 2; m <= 4; ++m) {
        const ExactPacking packing =
            read_packing(fmt::format("{}/packings/square_lattice_{}.toml", ISOSTAT_EXAMPLES, m)).packing;
        const auto stored = approximate(packing);
        const crafted::Inspection a = inspected(exact_copy(stored));
        const isostat::Counting b = isostat::count_contacts(stored, a.contacts);
        BOOST_TEST(a.rank == b.rank);
        BOOST_TEST(a.hyperstaticity == b.hyperstaticity);
        BOOST_TEST(a.mechanisms == b.mechanisms);
    }
}

BOOST_AUTO_TEST_CASE(beyond_the_limits_the_answers_are_bounds_and_say_so) {
    InspectionLimits limits;
    limits.kernel.cells = 1;
    const PackingFile file = parse_packing(contents("collinear_between_two.toml"), "collinear");
    const auto inspection = required(inspect(file.packing, limits));
    BOOST_TEST((inspection.rank_exact == Verdict::undecided));
    BOOST_TEST((inspection.special_position == Verdict::undecided));
    BOOST_TEST(inspection.verdict() == "undecided");
    BOOST_TEST(!check_expected(inspection, file, "collinear").empty());
    // Full rank needs no kernel.
    const auto full = inspect(parse_packing(contents("two_disks.toml"), "two").packing, limits);
    BOOST_TEST((full.value().rank_exact == Verdict::proved));
    BOOST_TEST(full.value().verdict() == "isostatic");
    BOOST_TEST((full.value().stable == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(lattices_of_thousands_of_disks_are_counted_exactly_within_seconds) {
    for (const int m : {30, 70}) {
        const ExactPacking packing = triangular(m, m, true);
        const auto start = std::chrono::steady_clock::now();
        const crafted::Inspection inspection = inspected(packing);
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        BOOST_TEST_MESSAGE(m << " x " << m << ": " << elapsed.count() << " s, N = " << inspection.contacts.size()
                             << ", h = " << inspection.hyperstaticity);
        BOOST_TEST((inspection.rank_exact == Verdict::proved));
        BOOST_TEST(inspection.mechanisms == 0);
        // In the rows, between them, floor and ceiling, sides.
        BOOST_TEST(inspection.contacts.size() == static_cast<std::size_t>((m - 1) * (3 * m - 1) + 2 * m + m));
    }
}

BOOST_AUTO_TEST_CASE(a_byte_order_mark_shifts_no_number) {
    // Unquoted numbers are taken from the text, at the columns that the parser gives: 2.45 must not become 2.4.
    const std::string text = "disks = [[ 0.0, 0.0, 1.25], [ 2.45, 0.0, 1.25]]\n" + head;
    const PackingFile plain = parse_packing(text, "file.toml"),
                      marked = parse_packing("\xEF\xBB\xBF" + text, "file.toml");
    BOOST_TEST(plain.packing.centre[1][0].text() == "49/20");
    BOOST_TEST(marked.packing.centre[1][0].text() == "49/20");
    BOOST_TEST(marked.packing.radius[1].text() == "5/4");
}

BOOST_AUTO_TEST_CASE(every_example_packing_has_the_answers_it_carries) {
    using namespace isostat::crafted;
    std::vector<std::string> paths = examples::packing_files();
    BOOST_TEST(paths.size() >= 25u);
    const std::vector<std::string> spheres = examples::packing_files(true);
    BOOST_TEST(spheres.size() >= 8u);
    const std::vector<std::string> clumps = examples::packing_files(false, true);
    paths.insert(paths.end(), spheres.begin(), spheres.end());
    paths.insert(paths.end(), clumps.begin(), clumps.end());
    for (const std::string& path : paths) {
        BOOST_TEST_INFO_SCOPE(path);
        const PackingFile file = read_packing(path);
        BOOST_TEST(file.expected.size() >= 3u);
        const auto inspection = required(inspect(file.packing));
        for (const std::string& message : check_expected(inspection, file, path)) {
            BOOST_ERROR(message);
        }
        BOOST_TEST(!to_text(inspection, file.packing).empty());
    }
}

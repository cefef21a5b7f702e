import csv
import unittest

import lowlap
import numpy as np

from support import LeastSquares


class AveragerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.truth = lowlap.simulate(views=8, pairs="window:2")

    def test_is_a_row_of_the_table(self):
        comparison = lowlap.compare(self.scene, self.truth,
                                    ["graph", LeastSquares(), "lud:loss_width=1e-4"])
        names = [result.strategy for result in comparison.results]
        self.assertEqual(names, ["graph", "least_squares", "lud:loss_width=1e-4"])
        result = comparison.results[1]
        self.assertIsNone(result.failure)
        self.assertEqual(result.num_placed, 8)
        # Ratios are found to about 1e-5 without noise; the room has metres.
        self.assertLess(result.before.errors.position.max, 1e-3)
        # What lies near a plane and not on it pulls a little.
        self.assertLess(result.after.errors.position.max, 1e-5)
        by_pairs = lowlap.compare(self.scene, self.truth, [LeastSquares()],
                                  coplanar_ties="pairs")
        self.assertLess(by_pairs.results[0].after.errors.position.max, 1e-6)
        self.assertIn("least_squares", str(comparison))
        rows = list(csv.DictReader(comparison.to_csv().splitlines()))
        self.assertEqual([row["strategy"] for row in rows], names)

    def test_built_in_ones_keep_their_request(self):
        requests = ["graph", "lud:loss_width=1e-4", "lud:loss_width=1e-3"]
        strategies = [requests[0], *map(lowlap.averager, requests[1:])]
        comparison = lowlap.compare(self.scene, self.truth, strategies)
        self.assertEqual([result.strategy for result in comparison.results], requests)
        as_texts = lowlap.compare(self.scene, self.truth, requests)
        self.assertEqual(comparison.results[2].before.errors.position.mean,
                         as_texts.results[2].before.errors.position.mean)

    def test_solves_a_scene(self):
        solution = lowlap.solve(self.scene, strategy=LeastSquares(), gt=self.truth)
        self.assertEqual(solution.num_placed, 8)
        self.assertLess(solution.evaluation.position.max, 1e-5)

    def test_may_stand_on_a_built_in_one(self):
        class Standing(lowlap.TranslationAverager):
            def name(self):
                return "standing"

            def solve(self, problem):
                return lowlap.averager("graph").solve(problem)

        graph, standing = lowlap.compare(self.scene, None, ["graph", Standing()]).results
        self.assertEqual(list(graph.poses), list(standing.poses))
        for id, pose in graph.poses.items():
            np.testing.assert_array_equal(standing.poses[id].center, pose.center)

    def test_works_with_filters(self):
        comparison = lowlap.compare(self.scene, None,
                                    [LeastSquares(), "1dsfm+least_squares"])
        self.assertEqual([result.failure for result in comparison.results], [None, None])

    def test_places_some_views(self):
        class Half(LeastSquares):
            def name(self):
                return "half"

            def solve(self, problem):
                centers = super().solve(problem)
                centers[5:] = np.nan
                return centers

            def needs(self):
                return "a low number"

        result = lowlap.compare(self.scene, None, [Half()]).results[0]
        self.assertEqual(result.unplaced, [5, 6, 7])
        self.assertIn("a low number", result.limit)

    def test_components_come_by_size(self):
        class Parts(LeastSquares):
            def name(self):
                return "parts"

            def solve(self, problem):
                return super().solve(problem), [0, 0, -1, 4, 4, 4, 4, 4]

        result = lowlap.compare(self.scene, None, [Parts()]).results[0]
        self.assertEqual(result.num_components, 2)
        self.assertEqual(result.unplaced, [0, 1, 2])

    def test_its_errors_are_results_and_its_mistakes_are_raised(self):
        class Failing(lowlap.TranslationAverager):
            def __init__(self, failure):
                self.failure = failure

            def name(self):
                return "failing"

            def solve(self, problem):
                if isinstance(self.failure, Exception):
                    raise self.failure
                return self.failure

        strategies = [Failing(lowlap.Error("unsupported", "too large")), "graph"]
        failed, graph = lowlap.compare(self.scene, None, strategies).results
        self.assertIn("too large", failed.failure)
        self.assertIsNone(graph.failure)
        with self.assertRaisesRegex(lowlap.Error, "too large") as caught:
            lowlap.solve(self.scene, strategy=strategies[0])
        self.assertEqual(caught.exception.code, "unsupported")

        for wrong in (None, np.zeros((3, 3)), "centres", (np.zeros((8, 3)), [0]),
                      (np.zeros((8, 3)), np.zeros(8)), (np.zeros((8, 3)), None)):
            with self.subTest(wrong), self.assertRaisesRegex(lowlap.Error, "a row for each"):
                lowlap.solve(self.scene, strategy=Failing(wrong))
        for call in (lambda mine: lowlap.solve(self.scene, strategy=mine),
                     lambda mine: lowlap.compare(self.scene, None, [mine])):
            with self.assertRaisesRegex(IndexError, "mine"):
                call(Failing(IndexError("mine")))

    def test_names_are_texts(self):
        class Numbered(LeastSquares):
            def name(self):
                return 7

        with self.assertRaisesRegex(TypeError, "name.* cannot be 7"):
            lowlap.solve(self.scene, strategy=Numbered())

    def test_problems_outlive_the_call(self):
        kept = []

        class Keeping(LeastSquares):
            def needs_tracks(self):
                return True

            def solve(self, problem):
                kept.append((problem.directions, problem.tracks[0]))
                return super().solve(problem)

        lowlap.solve(self.scene, strategy=Keeping(), no_adjust=True)
        directions, (views, rays) = kept[0]
        self.assertFalse(directions.flags.owndata)
        np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-9)
        self.assertEqual(rays.shape, (len(views), 3))

    def test_built_in_strategies_solve_problems(self):
        solved = lowlap.solve(self.scene, no_adjust=True).scene
        problem = lowlap.translation_problem(solved)
        np.testing.assert_allclose(
            problem.rotations @ problem.rotations.transpose(0, 2, 1),
            np.broadcast_to(np.eye(3), problem.rotations.shape), atol=1e-9)
        for name in ("graph", "chain"):
            centers, components = lowlap.averager(name).solve(problem)
            self.assertEqual(set(components), {0}, name)
            # The measured directions, from first to second view.
            baselines = np.array([centers[j] - centers[i] for i, j in problem.edges])
            baselines /= np.linalg.norm(baselines, axis=1)[:, None]
            np.testing.assert_allclose(baselines, problem.directions, atol=1e-3)
        self.assertIn("graph", lowlap.strategies())

    def test_an_averager_must_say_how_it_solves(self):
        class Nothing(lowlap.TranslationAverager):
            pass

        with self.assertRaises(TypeError):
            Nothing()


if __name__ == "__main__":
    unittest.main()

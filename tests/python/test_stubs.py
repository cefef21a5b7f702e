"""The stubs say of the module what it is."""

import ast
import inspect
import unittest
from pathlib import Path

import lowlap


def read_stub():
    path = Path(lowlap.__file__).with_name("__init__.pyi")
    return ast.parse(path.read_text()).body


class StubTest(unittest.TestCase):
    def test_every_name_is_there(self):
        stubbed = {node.name: node for node in read_stub()
                   if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        public = {name for name in lowlap.__all__ if not name.endswith("Map")}
        self.assertEqual(set(stubbed), public)
        for name, node in stubbed.items():
            thing = getattr(lowlap, name)
            self.assertEqual(inspect.isclass(thing), isinstance(node, ast.ClassDef), name)
            self.assertTrue(name[0].islower() or isinstance(node, ast.ClassDef))
            if not isinstance(node, ast.ClassDef) or name == "Error":
                continue
            members = {each.name if isinstance(each, ast.FunctionDef) else each.target.id
                       for each in node.body}
            actual = {member for member in dir(thing) if not member.startswith("_")}
            self.assertEqual(members - {"__init__"}, actual, name)

    def test_options_are_those_that_are_known(self):
        checked = 0
        for node in read_stub():
            if not isinstance(node, ast.FunctionDef) or not node.args.kwonlyargs:
                continue
            required = len(node.args.args) - len(node.args.defaults)
            scene, _ = lowlap.simulate(views=3)
            with self.assertRaises(TypeError) as caught:
                getattr(lowlap, node.name)(*[scene] * required if node.name != "run"
                                           else ["images"], no_such_option=1)
            known = str(caught.exception).split("it has ")[1].split(", ")
            options = {argument.arg for argument in node.args.kwonlyargs}
            self.assertEqual(options, set(known), node.name)
            documentation = getattr(lowlap, node.name).__doc__
            if node.name != "run":  # which refers to solve()
                for option in options:
                    self.assertIn(option, documentation, node.name)
            checked += 1
        self.assertGreaterEqual(checked, 6)

    def test_everything_is_documented(self):
        for name in lowlap.__all__:
            thing = getattr(lowlap, name)
            if inspect.isclass(thing):
                self.assertTrue(thing.__doc__, name)
            else:
                # A signature, and more.
                self.assertGreater(len(thing.__doc__.splitlines()), 1, name)


if __name__ == "__main__":
    unittest.main()

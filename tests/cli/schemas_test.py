"""The schemas of the reports are schemas, and tell valid examples from invalid ones."""
import json
import unittest

import jsonschema

from support import ROOT, TOOLS, schema_of, validate_report


def examples(kind, tool):
    return sorted((ROOT / "schemas" / "examples" / kind).glob(f"{tool}.report.*.json"))


class Schemas(unittest.TestCase):
    def test_are_schemas(self):
        for tool in TOOLS:
            jsonschema.Draft202012Validator.check_schema(schema_of(tool))

    def test_accept_valid_examples(self):
        for tool in TOOLS:
            found = examples("valid", tool)
            self.assertTrue(found, tool)
            for path in found:
                with self.subTest(path.name):
                    validate_report(tool, json.loads(path.read_text()))

    def test_refuse_invalid_examples(self):
        for tool in TOOLS:
            found = examples("invalid", tool)
            self.assertTrue(found, tool)
            for path in found:
                with self.subTest(path.name), self.assertRaises(jsonschema.ValidationError):
                    validate_report(tool, json.loads(path.read_text()))


if __name__ == "__main__":
    unittest.main()

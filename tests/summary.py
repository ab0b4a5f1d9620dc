"""Adds up JUnit files and prints the closing line: summary.py BROKEN_STEPS FILE..."""

import sys
import xml.etree.ElementTree


def count(path):
    passed = failed = skipped = 0
    for case in xml.etree.ElementTree.parse(path).iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def main():
    broken = int(sys.argv[1])
    totals = [0, broken, 0]
    for path in sys.argv[2:]:
        counts = count(path)
        totals = [total + more for total, more in zip(totals, counts)]
        print(f"{path.rsplit('/', 1)[-1]}: {counts[0]} passed, {counts[1]} failed, "
              f"{counts[2]} skipped")
    passed, failed, skipped = totals
    if broken:
        print(f"{broken} steps could not be run and count as failed")
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed or not passed else 0


sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""run_cases.py PROGRAM [ARGUMENTS...]: runs a Catch2 program in a build without Embree or OpenImageIO.

All cases run. Those that fail by nothing but what such a build refuses are told apart from those that
fail otherwise, and named: they are for builds that have what they ask for.
"""
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

REFUSALS = ('this build has no Embree', 'TIFF files need that module')


def is_refusal(failure):
    """Whether a failed element of Catch2's report is an exception that says what the build has not."""
    exception = failure if failure.tag == 'Exception' else failure.find('Exception')
    return exception is not None and any(text in exception.text for text in REFUSALS)


def failures_of(case):
    """The failed elements of a case, each once."""
    expressions = [e for e in case.iter('Expression') if e.get('success') == 'false']
    within = {id(exception) for e in expressions for exception in e.iter('Exception')}
    others = [e for tag in ('Exception', 'Failure', 'FatalErrorCondition') for e in case.iter(tag)
              if id(e) not in within]
    return expressions + others


def main():
    command = [sys.argv[1], '--reporter', 'xml', *sys.argv[2:]]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    passed, refused, failed = [], [], []
    for case in ElementTree.fromstring(result.stdout).iter('TestCase'):
        failures = failures_of(case)
        if case.find('OverallResult').get('success') == 'true':
            passed.append(case)
        elif failures and all(is_refusal(failure) for failure in failures):
            refused.append(case)
        else:
            failed.append(case)
    print(f'{len(passed)} cases passed; {len(refused)} are for builds with Embree and OpenImageIO:')
    for case in refused:
        print(f'  {case.get("name")}')
    for case in failed:
        print(f'failed: {case.get("name")}')
        for failure in failures_of(case):
            print(ElementTree.tostring(failure, encoding='unicode'))
    return 1 if failed or not passed else 0


if __name__ == '__main__':
    sys.exit(main())

"""`elastocheck study`: exit codes 0, 2 for bad input, 3 where not all could be judged, 4 for a bug."""
import argparse
import shlex
import sys
import warnings


def _progress(what, done):
    print(f"\r{what}\033[K", end="" if done < 1 else "\r\033[K", file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser("elastocheck.study", description="Many variants of a scene; elastocheck study --help")
    parser.add_argument("file", metavar="STUDY")
    for option in ("--shard", "--scheduler", "--csv", "--hdf5", "--reproduce"):
        parser.add_argument(option)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--count", type=int)
    parser.add_argument("-j", "--jobs", type=int, default=0)
    parser.add_argument("--merge", nargs="*", action="extend", default=[])
    for option in ("--show", "--rare", "--quiet", "--json"):
        parser.add_argument(option, action="store_true")
    given = parser.parse_args()

    def say(words):
        print(words, file=sys.stderr)

    try:
        from elastocheck import Error, study
        from elastocheck.study import output
        warnings.showwarning = lambda message, *_: say(f"{message} (warning)")
        report = study.run(
            given.file, given.output, given.count, threads=given.jobs, scheduler=given.scheduler, shard=given.shard,
            merge=given.merge, show=given.show, rare=given.rare, csv=given.csv, hdf5=given.hdf5,
            reproduce=given.reproduce or shlex.join(["elastocheck", "study", *sys.argv[1:]]), say=say,
            progress=_progress if sys.stderr.isatty() and not given.quiet else None)
    except ImportError as error:
        say(f"elastocheck: study: {error}; `./dev study` installs what it needs")
        return 2
    except (Error, OSError) as error:
        say(f"elastocheck: {error}")
        return 2
    if report:
        print(output.to_json(report.document) if given.json else report.text, end="")
    return report.exit_code if report else 0


if __name__ == "__main__":
    sys.exit(main())

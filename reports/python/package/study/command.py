"""`elastocheck study`: exit codes 0, 2 for bad input, 3 where not all could be judged, 4 for a bug."""
import sys
import traceback
import warnings

from elastocheck import Error, study


def main(quiet=False, as_json=False, **options):
    """Options as those of elastocheck.study.run()."""
    def say(words, end="\n"):
        print(words, end=end, file=sys.stderr, flush=True)

    def progress(what, done):
        say(f"\r{what}\033[K", "" if done < 1 else "\r\033[K")

    warnings.showwarning = lambda message, *_: say(f"{message} (warning)")
    try:
        report = study.run(**options, say=say, progress=progress if sys.stderr.isatty() and not quiet else None)
    except (Error, ImportError) as error:
        say(f"elastocheck: {error}" + ("; `./dev study` installs what it needs" if isinstance(error, ImportError) else ""))
        return 2
    except OSError as error:
        say(f"elastocheck: {error.filename}: {error.strerror}")
        return 2
    except KeyboardInterrupt:
        say("\nelastocheck: interrupted; the same command goes on")
        return 130
    except Exception:  # a bug
        traceback.print_exc()
        return 4
    if report is None:  # of a shard
        return 0
    print(report.printed if as_json else report.text, end="")
    return report.exit_code

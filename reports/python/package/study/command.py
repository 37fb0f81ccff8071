"""`elastocheck study`: exit codes 0, 2 for bad input, 3 where not all could be judged, 4 for a bug."""
import sys
import traceback
import warnings

from elastocheck import Error, study


def _say(words):
    print(words, file=sys.stderr)


def _progress(what, done):
    print(f"\r{what}\033[K", end="" if done < 1 else "\r\033[K", file=sys.stderr, flush=True)


def main(quiet=False, as_json=False, **options):
    """Options as those of elastocheck.study.run()."""
    warnings.showwarning = lambda message, *_: _say(f"{message} (warning)")
    try:
        report = study.run(**options, say=_say, progress=_progress if sys.stderr.isatty() and not quiet else None)
    except ImportError as error:
        _say(f"elastocheck: study: {error}; `./dev study` installs what it needs")
        return 2
    except (Error, OSError) as error:
        file = getattr(error, "filename", None)
        _say(f"elastocheck: {file}: {error.strerror}" if file else f"elastocheck: {error}")
        return 2
    except KeyboardInterrupt:
        _say("\nelastocheck: interrupted; the same command goes on")
        return 130
    except Exception:  # a bug
        traceback.print_exc()
        return 4
    if report is None:  # of a shard
        return 0
    print(report.printed if as_json else report.text, end="")
    return report.exit_code

# For scripts that start a server and see that its page answers.

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# page_answers PORT COMMAND…: runs the command until the page at the address on its last line answers, says how long
# that took, and ends it. Fails where it ends by itself, names another port, or takes more than half an hour.
page_answers() {
    local port=$1 said began
    shift
    said=$(mktemp)
    began=$(date +%s)
    "$@" >"$said" 2>&1 &
    local command=$!
    until opens "$(tail -n 1 "$said" | grep -o "http://localhost:$port[^ ]*")"; do
        if ! kill -0 "$command" 2>/dev/null || test $(($(date +%s) - began)) -gt 1800; then
            cat "$said"
            echo "$*: no page at the address on its last line."
            return 1
        fi
        sleep 0.2
    done
    echo "$*: the page answered after $(($(date +%s) - began)) s"
    kill -TERM "$command"
    wait "$command" || test $? -eq 143 -o $? -eq 2
    rm "$said"
}

# opens ADDRESS: whether a browser that keeps cookies gets a page there.
opens() {
    python3 - "$1" <<'PYTHON' 2>/dev/null
import sys
from urllib.request import HTTPCookieProcessor, build_opener

with build_opener(HTTPCookieProcessor()).open(sys.argv[1], timeout=10) as page:
    assert b"Fairyring" in page.read()
PYTHON
}

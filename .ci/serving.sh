# For scripts that start a server and see that its page answers.

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# page_answers PORT COMMAND…: runs the command until the page at the port answers, says how long that took, and
# ends it; fails where it ends by itself, or its last line is not the page's address.
page_answers() {
    local port=$1 said began
    shift
    said=$(mktemp)
    began=$(date +%s)
    "$@" >"$said" 2>&1 &
    local command=$!
    until python3 -c "from urllib.request import urlopen; urlopen('http://localhost:$port/')" 2>/dev/null; do
        if ! kill -0 "$command" 2>/dev/null; then
            cat "$said"
            echo "$* ended before its page answered."
            return 1
        fi
        sleep 0.2
    done
    echo "$*: the page answered after $(($(date +%s) - began)) s"
    sleep 1
    tail -n 1 "$said" | grep -F "http://localhost:$port"
    kill -TERM "$command"
    wait "$command" || test $? -eq 143 -o $? -eq 2
    rm "$said"
}

// Pictures for billboards, drawn here so that no file is needed.

const side = 64;

function drawing(draw: (context: CanvasRenderingContext2D) => void): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = side;
  const context = canvas.getContext("2d")!;
  context.lineJoin = context.lineCap = "round";
  draw(context);
  return canvas;
}

/// Body and lens, light with a dark rim.
export const cameraIcon = (): HTMLCanvasElement =>
  drawing((c) => {
    c.strokeStyle = "#14171c";
    c.fillStyle = "#f2f4f7";
    c.lineWidth = 4;
    c.beginPath();
    c.roundRect(6, 20, 34, 28, 5);
    c.fill();
    c.stroke();
    c.beginPath();
    c.moveTo(44, 34);
    c.lineTo(58, 23);
    c.lineTo(58, 45);
    c.closePath();
    c.fill();
    c.stroke();
    c.beginPath();
    c.arc(23, 34, 6, 0, 2 * Math.PI);
    c.fillStyle = "#ff2d2d";
    c.fill();
  });

/// A disc with eight rays.
export const lightIcon = (): HTMLCanvasElement =>
  drawing((c) => {
    const spokes = (width: number, color: string) => {
      c.strokeStyle = color;
      c.lineWidth = width;
      for (let i = 0; i < 8; ++i) {
        const [x, y] = [Math.cos((i * Math.PI) / 4), Math.sin((i * Math.PI) / 4)];
        c.beginPath();
        c.moveTo(32 + 19 * x, 32 + 19 * y);
        c.lineTo(32 + 26 * x, 32 + 26 * y);
        c.stroke();
      }
    };
    spokes(9, "#14171c");
    spokes(5, "#ffd23f");
    c.beginPath();
    c.arc(32, 32, 12, 0, 2 * Math.PI);
    c.fillStyle = "#ffd23f";
    c.strokeStyle = "#14171c";
    c.lineWidth = 4;
    c.stroke();
    c.fill();
  });

export const letterIcon = (letter: string, color: string): HTMLCanvasElement =>
  drawing((c) => {
    c.font = "bold 46px sans-serif";
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.strokeStyle = "rgb(0 0 0 / 60%)";
    c.lineWidth = 8;
    c.strokeText(letter, 32, 32);
    c.fillStyle = color;
    c.fillText(letter, 32, 32);
  });

/// White, to be tinted, with a dark rim.
export const dotIcon = (): HTMLCanvasElement =>
  drawing((c) => {
    c.beginPath();
    c.arc(32, 32, 24, 0, 2 * Math.PI);
    c.fillStyle = "#ffffff";
    c.strokeStyle = "#14171c";
    c.lineWidth = 12;
    c.stroke();
    c.fill();
  });
